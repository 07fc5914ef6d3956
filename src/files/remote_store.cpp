#include "files/remote_store.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <random>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "files/content_range.hpp"
#include "files/http_client.hpp"
#include "files/input_file.hpp"
#include "files/remote_address.hpp"
#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"

namespace isoweave {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOk = 200, kPartOfObject = 206, kForbidden = 403, kNotFound = 404, kGone = 410;
constexpr double kFirstPause = 0.25, kLongestPause = 60;
// Between two looks at whether the caller has asked to stop.
constexpr double kLook = 0.1;

// 408: the server waited too long; 425: too early; 429: too many requests; 5xx: faults that may pass.
bool may_pass(const HttpAnswer& answer) {
  static constexpr std::array kStatuses{408, 425, 429, 500, 502, 503, 504};
  if (!answer.failure.empty()) return !answer.lasting;
  return std::ranges::find(kStatuses, answer.status) != kStatuses.end();
}

bool is_absent(const HttpAnswer& answer) {
  return answer.failure.empty() && (answer.status == kNotFound || answer.status == kGone);
}

// A question to the server: for the bytes of a part, or for how many an object has.
struct Wish {
  ObjectPart part;
  bool size = false;

  bool operator==(const Wish&) const = default;
  bool operator<(const Wish& other) const { return std::tie(part, size) < std::tie(other.part, other.size); }
};

// A wish that is under way, waits to be tried again, or is over.
struct Fetch {
  std::uint64_t number = 0;
  int tries = 0;
  bool running = false, over = false;
  Clock::time_point not_before{};
  HttpAnswer answer{};
};

// No range of bytes stands for none.
bool is_nothing(const ObjectPart& part) { return !part.whole && part.bytes == 0; }

std::string found_text(const HttpAnswer& answer, int tries) {
  std::string found = answer.failure.empty() ? "status " + std::to_string(answer.status) : answer.failure;
  if (tries > 1) found += " after " + std::to_string(tries) + " tries";
  return found;
}

class RemoteStore final : public ObjectStore {
 public:
  RemoteStore(const std::string& url, RemoteOptions options)
      : address_(remote_address(url)),
        options_(std::move(options)),
        client_(address_.shown, options_.timeout),
        random_(std::random_device{}()) {}

  std::optional<std::vector<std::byte>> read(const ObjectPart& part) override {
    if (is_nothing(part)) return std::vector<std::byte>();
    std::optional<HttpAnswer> answer = object_or_part(part);
    if (!answer) return std::nullopt;
    if (!part.whole) remember(part.path, *answer, checked_size(part, *answer));
    return std::move(answer->body);
  }

  std::optional<std::vector<std::byte>> look_for(const ObjectPart& part) override {
    const Wish wish{part, false};
    HttpAnswer& answer = answer_of(wish).answer;
    // S3 answers so for objects that it lacks in a bucket that may not be listed.
    if (answer.failure.empty() && answer.status == kForbidden) {
      is_forbidden_ = true;
      fetches_.erase(wish);
      return std::nullopt;
    }
    std::optional<HttpAnswer> found = object_or_part(part);
    if (!found) return std::nullopt;
    remember(part.path, *found, found->body.size());
    return std::move(found->body);
  }

  std::optional<std::uint64_t> size(const std::string& path) override {
    const auto [answer, tries] = answer_to({{path, 0, 0, true}, true});
    if (is_absent(answer)) return std::nullopt;
    if (!answer.failure.empty() || answer.status != kOk || !answer.bytes) {
      bad_input(path, "an object with a size", found_text(answer, tries));
    }
    remember(path, answer, *answer.bytes);
    return answer.bytes;
  }

  void expect(const std::vector<ObjectPart>& parts) override {
    std::map<Wish, Fetch> kept;
    queue_.clear();
    for (const ObjectPart& part : parts) {
      if (is_nothing(part)) continue;
      auto found = fetches_.extract(Wish{part, false});
      if (found.empty()) {
        queue_.push_back({part, false});
      } else {
        kept.insert(std::move(found));
      }
    }
    for (const auto& [wish, fetch] : fetches_) client_.cancel(fetch.number);
    fetches_ = std::move(kept);
    start_some();
  }

  bool is_local() const override { return false; }

  std::optional<FolderAbove> above(const std::string& folder) const override {
    const std::size_t slash = folder.rfind('/');
    if (slash == std::string::npos || slash <= address_.server.size()) return std::nullopt;
    return FolderAbove{folder.substr(0, slash), folder.substr(slash + 1)};
  }

  std::string identity(const std::string& path) const override {
    const auto found = seen_.find(path);
    return found == seen_.end() ? std::string() : found->second;
  }

  std::string why_nothing() const override { return is_forbidden_ ? "status 403" : "none"; }

  std::uint64_t held_bytes() const override { return options_.ahead; }

 private:
  // Nothing where there is no such object.
  std::optional<HttpAnswer> object_or_part(const ObjectPart& part) {
    auto [answer, tries] = answer_to({part, false});
    if (is_absent(answer)) return std::nullopt;
    if (answer.too_long) bad_input(part.path, "at most " + std::to_string(part.bytes) + " bytes", "more");
    const bool done = answer.failure.empty() && answer.status == (part.whole ? kOk : kPartOfObject);
    if (!done) refuse(part, answer, tries);
    return std::move(answer);
  }

  [[noreturn]] void refuse(const ObjectPart& part, const HttpAnswer& answer, int tries) const {
    if (!part.whole && answer.failure.empty() && answer.status == kOk) {
      bad_input(part.path, "a server that sends parts of objects (status 206)",
                "one that sends the whole (status 200)");
    }
    const bool unsigned_s3 = address_.shown.starts_with("s3:") && address_.access.signed_for.empty();
    const bool forbidden = answer.failure.empty() && answer.status == kForbidden;
    bad_input(
        part.path, "the object",
        found_text(answer, tries) +
            (forbidden && unsigned_s3 ? ", unsigned: AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY are not set" : ""));
  }

  // The size of the whole object, of which a part has come.
  static std::uint64_t checked_size(const ObjectPart& part, const HttpAnswer& answer) {
    const std::optional<ContentRange> range = parse_content_range(answer.content_range);
    const std::uint64_t last = part.begin + part.bytes - 1;
    const bool right =
        range && range->size && range->first == part.begin && range->last == last && answer.body.size() == part.bytes;
    if (!right) {
      bad_input(part.path, "bytes " + std::to_string(part.begin) + " to " + std::to_string(last),
                std::to_string(answer.body.size()) + " bytes as '" + printable(answer.content_range) + "'");
    }
    return *range->size;
  }

  // Refuses an object that has changed since it was read before. Objects that are read once are not remembered.
  void remember(const std::string& path, const HttpAnswer& answer, std::uint64_t size) {
    const std::string& stamp = answer.etag.empty() ? answer.modified : answer.etag;
    const std::string now = std::to_string(size) + " bytes, " + (stamp.empty() ? "no ETag" : printable(stamp));
    const auto [before, is_new] = seen_.try_emplace(path, now);
    if (!is_new && before->second != now) {
      bad_input(path, "an object that stays as it is while it is read (" + before->second + ")", now);
    }
  }

  // Takes an answer out.
  std::pair<HttpAnswer, int> answer_to(const Wish& wish) {
    Fetch& fetch = answer_of(wish);
    std::pair<HttpAnswer, int> taken{std::move(fetch.answer), fetch.tries};
    fetches_.erase(wish);
    return taken;
  }

  // Waits until a wish is over, and works on others meanwhile.
  Fetch& answer_of(const Wish& wish) {
    const auto [found, is_new] = fetches_.try_emplace(wish);
    if (is_new) {
      std::erase(queue_, wish);
      start(wish, found->second);
    }
    Fetch& fetch = found->second;
    start_some();
    while (!fetch.over) {
      if (options_.stop && options_.stop->load()) {
        throw Interrupted("interrupted while " + printable(wish.part.path) + " was read");
      }
      if (const std::optional<HttpClient::Done> done = client_.wait(kLook)) take(*done);
      start_waiting();
      start_some();
    }
    return fetch;
  }

  void start(const Wish& wish, Fetch& fetch) {
    HttpRequest request{address_.request_url(wish.part.path), address_.access, wish.size, {}, wish.part.bytes};
    if (!wish.part.whole) {
      request.range = std::to_string(wish.part.begin) + "-" + std::to_string(wish.part.begin + wish.part.bytes - 1);
    }
    fetch.number = ++last_number_;
    ++fetch.tries;
    fetch.running = true;
    client_.start(fetch.number, request);
  }

  void take(const HttpClient::Done& done) {
    const auto is_it = [&](const auto& entry) { return entry.second.number == done.number; };
    const auto found = std::ranges::find_if(fetches_, is_it);
    if (found == fetches_.end()) return;
    Fetch& fetch = found->second;
    fetch.running = false;
    fetch.answer = done.answer;
    fetch.over = !may_pass(done.answer) || fetch.tries >= options_.tries;
    if (!fetch.over) fetch.not_before = Clock::now() + pause_before_next(fetch);
  }

  // Twice as long each time, of a length that differs between the many who ask; or what the server asks for.
  Clock::duration pause_before_next(const Fetch& fetch) {
    const double usual = kFirstPause * std::exp2(fetch.tries - 1) * std::uniform_real_distribution(0.75, 1.25)(random_);
    const double seconds = std::min(std::max(usual, fetch.answer.retry_after), kLongestPause);
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  // Tries again what has waited long enough.
  void start_waiting() {
    for (auto& [wish, fetch] : fetches_) {
      if (!fetch.over && !fetch.running && Clock::now() >= fetch.not_before) start(wish, fetch);
    }
  }

  // Starts requests for what is expected, as far as their number and the room allow.
  void start_some() {
    std::uint64_t held = 0;
    int open = 0;
    for (const auto& [wish, fetch] : fetches_) {
      held += fetch.over ? fetch.answer.body.size() : wish.part.bytes;
      open += fetch.over ? 0 : 1;
    }
    while (!queue_.empty() && open < options_.requests) {
      held += queue_.front().part.bytes;
      if (held > options_.ahead) return;
      start(queue_.front(), fetches_[queue_.front()]);
      queue_.pop_front();
      ++open;
    }
  }

  RemoteAddress address_;
  RemoteOptions options_;
  std::map<Wish, Fetch> fetches_;
  std::deque<Wish> queue_;  // expected, and not asked for yet
  std::uint64_t last_number_ = 0;
  HttpClient client_;
  std::minstd_rand random_;
  std::unordered_map<std::string, std::string> seen_;  // objects of which a later read must find the same
  bool is_forbidden_ = false;
};

}  // namespace

StorePtr open_remote_store(const std::string& url, const RemoteOptions& options) {
  check_remote_options(options);
  return std::make_shared<RemoteStore>(url, options);
}

}  // namespace isoweave
