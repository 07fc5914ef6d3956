// Requests through libcurl's multi interface. Proxies and certificates are those of curl's usual environment.
#include "files/http_client.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <new>
#include <string_view>
#include <utility>

#include "files/curl_library.hpp"
#include "files/header_text.hpp"

namespace isoweave {
namespace {

using Clock = std::chrono::steady_clock;

constexpr long kMostRedirects = 5;
constexpr std::size_t kLongestHeader = 256;
// SHA-256 of a body without bytes. S3 wants it in a header, which curl writes from version 8 on only.
constexpr std::string_view kHashOfNothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

using Easy = std::unique_ptr<CURL, decltype(&::curl_easy_cleanup)>;
using Multi = std::unique_ptr<CURLM, decltype(&::curl_multi_cleanup)>;
using List = std::unique_ptr<curl_slist, decltype(&::curl_slist_free_all)>;

// One request under way.
struct Transfer {
  explicit Transfer(const CurlFunctions& functions)
      : curl(functions),
        easy(functions.easy_init(), functions.easy_cleanup),
        headers(nullptr, functions.slist_free_all) {}

  const CurlFunctions& curl;
  HttpRequest request{};
  HttpAnswer answer{};
  Easy easy;
  List headers;
  double last_byte = 0;  // when it came, in seconds of waiting
  const double* waited = nullptr;
};

// Takes the value of a header of this name.
void take_header(std::string_view line, std::string_view name, std::string& value) {
  if (line.size() <= name.size() || line[name.size()] != ':' || lower_case(line.substr(0, name.size())) != name) return;
  value = trimmed(line.substr(name.size() + 1)).substr(0, kLongestHeader);
}

std::size_t on_header(const char* data, std::size_t, std::size_t count, void* given) {
  auto& transfer = *static_cast<Transfer*>(given);
  transfer.last_byte = *transfer.waited;
  const std::string_view line(data, count);
  HttpAnswer& answer = transfer.answer;
  // Each answer on the way, such as a redirect, has headers of its own.
  if (line.starts_with("HTTP/")) answer = {};
  take_header(line, "etag", answer.etag);
  take_header(line, "last-modified", answer.modified);
  take_header(line, "content-range", answer.content_range);
  return count;
}

int status_of(const Transfer& transfer) {
  long status = 0;
  transfer.curl.easy_getinfo(transfer.easy.get(), CURLINFO_RESPONSE_CODE, &status);
  return static_cast<int>(status);
}

std::size_t on_body(const char* data, std::size_t, std::size_t count, void* given) {
  auto& transfer = *static_cast<Transfer*>(given);
  transfer.last_byte = *transfer.waited;
  const int status = status_of(transfer);
  if (status != 200 && status != 206) return count;
  // An answer with all of the object is of no use where a part was asked for.
  if (!transfer.request.range.empty() && status == 200) return 0;
  std::vector<std::byte>& body = transfer.answer.body;
  transfer.answer.too_long = count > transfer.request.most - body.size();
  if (transfer.answer.too_long) return 0;
  const auto* const begin = reinterpret_cast<const std::byte*>(data);
  body.insert(body.end(), begin, begin + count);
  return count;
}

bool is_lasting(CURLcode code) {
  static constexpr std::array kLasting{
      CURLE_UNSUPPORTED_PROTOCOL, CURLE_URL_MALFORMAT,      CURLE_PEER_FAILED_VERIFICATION, CURLE_SSL_CACERT_BADFILE,
      CURLE_SSL_CERTPROBLEM,      CURLE_TOO_MANY_REDIRECTS, CURLE_BAD_CONTENT_ENCODING,     CURLE_NOT_BUILT_IN};
  return std::ranges::find(kLasting, code) != kLasting.end();
}

void add_header(Transfer& transfer, const std::string& line) {
  curl_slist* const list = transfer.curl.slist_append(transfer.headers.get(), line.c_str());
  if (list == nullptr) throw std::bad_alloc();
  static_cast<void>(transfer.headers.release());
  transfer.headers.reset(list);
}

void set_access(Transfer& transfer, CURL* easy) {
  const auto set = transfer.curl.easy_setopt;
  const HttpAccess& access = transfer.request.access;
  if (!access.bearer.empty()) {
    set(easy, CURLOPT_HTTPAUTH, CURLAUTH_BEARER);
    set(easy, CURLOPT_XOAUTH2_BEARER, access.bearer.c_str());
  }
  if (access.signed_for.empty()) return;
  set(easy, CURLOPT_AWS_SIGV4, access.signed_for.c_str());
  set(easy, CURLOPT_USERNAME, access.key.c_str());
  set(easy, CURLOPT_PASSWORD, access.secret.c_str());
  // A signature is for one host, and the token must not go to another.
  set(easy, CURLOPT_FOLLOWLOCATION, 0L);
  add_header(transfer, "x-amz-content-sha256: " + std::string(kHashOfNothing));
  if (!access.session_token.empty()) add_header(transfer, "x-amz-security-token: " + access.session_token);
  set(easy, CURLOPT_HTTPHEADER, transfer.headers.get());
}

void set_options(Transfer& transfer) {
  CURL* const easy = transfer.easy.get();
  const auto set = transfer.curl.easy_setopt;
  const HttpRequest& request = transfer.request;
  const char* const redirected_to = lower_case(request.url).starts_with("https") ? "https" : "http,https";
  set(easy, CURLOPT_URL, request.url.c_str());
  set(easy, CURLOPT_PROTOCOLS_STR, "http,https");
  set(easy, CURLOPT_REDIR_PROTOCOLS_STR, redirected_to);
  set(easy, CURLOPT_FOLLOWLOCATION, 1L);
  set(easy, CURLOPT_MAXREDIRS, kMostRedirects);
  set(easy, CURLOPT_NOSIGNAL, 1L);
  set(easy, CURLOPT_QUICK_EXIT, 1L);
  set(easy, CURLOPT_USERAGENT, "isoweave");
  set(easy, CURLOPT_NOBODY, request.head ? 1L : 0L);
  if (!request.range.empty()) {
    set(easy, CURLOPT_RANGE, request.range.c_str());
  } else if (!request.head) {
    set(easy, CURLOPT_ACCEPT_ENCODING, "gzip");
  }
  set(easy, CURLOPT_HEADERFUNCTION, on_header);
  set(easy, CURLOPT_HEADERDATA, &transfer);
  set(easy, CURLOPT_WRITEFUNCTION, on_body);
  set(easy, CURLOPT_WRITEDATA, &transfer);
  set_access(transfer, easy);
}

// The answer of a transfer that is over.
HttpAnswer answer_of(Transfer& transfer, CURLcode code) {
  CURL* const easy = transfer.easy.get();
  HttpAnswer& answer = transfer.answer;
  answer.status = status_of(transfer);
  curl_off_t bytes = -1, pause = 0;
  transfer.curl.easy_getinfo(easy, CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &bytes);
  transfer.curl.easy_getinfo(easy, CURLINFO_RETRY_AFTER, &pause);
  if (bytes >= 0) answer.bytes = static_cast<std::uint64_t>(bytes);
  answer.retry_after = static_cast<double>(pause);
  const bool stopped_here = code == CURLE_WRITE_ERROR;
  if (code != CURLE_OK && !stopped_here) {
    answer.failure = transfer.curl.easy_strerror(code);
    answer.lasting = is_lasting(code);
  }
  return std::move(answer);
}

}  // namespace

struct HttpClient::State {
  State(const CurlFunctions& functions, double seconds)
      : curl(functions), multi(functions.multi_init(), functions.multi_cleanup), timeout(seconds) {}

  const CurlFunctions& curl;
  std::map<std::uint64_t, Transfer> transfers{};
  Multi multi;
  double timeout;
  double waited = 0;  // seconds in wait(): outside of it nobody looks whether a server has answered

  ~State() {
    for (auto& [number, transfer] : transfers) curl.multi_remove_handle(multi.get(), transfer.easy.get());
  }

  Done end(std::map<std::uint64_t, Transfer>::iterator found, HttpAnswer answer) {
    Done done{found->first, std::move(answer)};
    curl.multi_remove_handle(multi.get(), found->second.easy.get());
    transfers.erase(found);
    return done;
  }

  std::optional<Done> one_over() {
    int left = 0;
    while (const CURLMsg* const message = curl.multi_info_read(multi.get(), &left)) {
      if (message->msg != CURLMSG_DONE) continue;
      const auto is_it = [&](const auto& entry) { return entry.second.easy.get() == message->easy_handle; };
      const auto found = std::ranges::find_if(transfers, is_it);
      if (found != transfers.end()) return end(found, answer_of(found->second, message->data.result));
    }
    return std::nullopt;
  }

  std::optional<Done> one_stalled() {
    const auto stalls = [&](const auto& entry) { return waited - entry.second.last_byte > timeout; };
    const auto found = std::ranges::find_if(transfers, stalls);
    if (found == transfers.end()) return std::nullopt;
    HttpAnswer answer;
    answer.failure = "no byte for " + number_text(timeout) + " seconds";
    return end(found, std::move(answer));
  }
};

HttpClient::HttpClient(const std::string& url, double timeout)
    : state_(std::make_unique<State>(curl_functions(url), timeout)) {}

HttpClient::~HttpClient() = default;

void HttpClient::start(std::uint64_t number, const HttpRequest& request) {
  Transfer& transfer = state_->transfers.try_emplace(number, state_->curl).first->second;
  transfer.request = request;
  transfer.waited = &state_->waited;
  transfer.last_byte = state_->waited;
  set_options(transfer);
  state_->curl.multi_add_handle(state_->multi.get(), transfer.easy.get());
}

void HttpClient::cancel(std::uint64_t number) {
  const auto found = state_->transfers.find(number);
  if (found != state_->transfers.end()) state_->end(found, {});
}

std::optional<HttpClient::Done> HttpClient::wait(double seconds) {
  const Clock::time_point begin = Clock::now();
  const double before = state_->waited;
  int running = 0;
  while (true) {
    state_->curl.multi_perform(state_->multi.get(), &running);
    state_->waited = before + seconds_since(begin);
    if (std::optional<Done> done = state_->one_over()) return done;
    if (std::optional<Done> done = state_->one_stalled()) return done;
    const double left = seconds - seconds_since(begin);
    if (left <= 0) return std::nullopt;
    state_->curl.multi_poll(state_->multi.get(), nullptr, 0, static_cast<int>(left * 1000) + 1, nullptr);
  }
}

}  // namespace isoweave
