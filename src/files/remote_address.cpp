#include "files/remote_address.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "isoweave/remote.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kSchemeEnd = "://";

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

std::string without_slashes(std::string text) {
  while (text.ends_with('/')) text.pop_back();
  return text;
}

// The pieces of SCHEME://USER@HOST/PATH?QUERY#FRAGMENT. A path begins with its slash, a query with its mark.
struct UrlPieces {
  std::string scheme, user, host, path, query;
};

UrlPieces pieces_of(const std::string& url) {
  UrlPieces pieces;
  const std::size_t scheme = url.find(kSchemeEnd);
  pieces.scheme = lower_case(url.substr(0, scheme));
  std::string rest = url.substr(scheme + kSchemeEnd.size());
  rest.resize(std::min(rest.find('#'), rest.size()));
  const std::size_t query = std::min(rest.find('?'), rest.size());
  pieces.query = rest.substr(query);
  rest.resize(query);
  const std::size_t host = std::min(rest.find('/'), rest.size());
  pieces.path = without_slashes(rest.substr(host));
  rest.resize(host);
  const std::size_t user = rest.rfind('@');
  if (user != std::string::npos) pieces.user = rest.substr(0, user + 1);
  pieces.host = rest.substr(user == std::string::npos ? 0 : user + 1);
  return pieces;
}

bool is_plain(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
         std::string_view("-._~/").find(letter) != std::string_view::npos;
}

// Percent signs stand for themselves in the name of an object, and for other characters in a part of a URL.
std::string encoded(std::string_view path, bool all) {
  constexpr std::string_view kKept = "%!$&'()*+,;=:@";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const char letter : path) {
    if (is_plain(letter) || (!all && kKept.find(letter) != std::string_view::npos)) {
      text += letter;
    } else {
      const auto code = static_cast<unsigned char>(letter);
      text += {'%', kDigits[code >> 4U], kDigits[code & 15U]};
    }
  }
  return text;
}

void address_s3(RemoteAddress& address, const std::string& bucket) {
  std::string region = environment("AWS_REGION");
  if (region.empty()) region = environment("AWS_DEFAULT_REGION");
  if (region.empty()) region = "us-east-1";
  const std::string endpoint = without_slashes(environment("AWS_ENDPOINT_URL"));
  // Certificates are for names of one level below the service.
  const bool in_path = bucket.find('.') != std::string::npos;
  address.base = !endpoint.empty() ? endpoint + "/" + bucket
                 : in_path         ? "https://s3." + region + ".amazonaws.com/" + bucket
                                   : "https://" + bucket + ".s3." + region + ".amazonaws.com";
  HttpAccess access{{},
                    "aws:amz:" + region + ":s3",
                    environment("AWS_ACCESS_KEY_ID"),
                    environment("AWS_SECRET_ACCESS_KEY"),
                    environment("AWS_SESSION_TOKEN")};
  if (!access.key.empty() && !access.secret.empty()) address.access = access;
}

void address_gs(RemoteAddress& address, const std::string& bucket) {
  std::string host = without_slashes(environment("STORAGE_EMULATOR_HOST"));
  if (host.empty()) host = "https://storage.googleapis.com";
  if (!is_url(host)) host.insert(0, "http://");
  address.base = host + "/" + bucket;
  address.access.bearer = environment("GOOGLE_OAUTH_ACCESS_TOKEN");
}

}  // namespace

bool is_url(std::string_view path) {
  static constexpr std::array<std::string_view, 4> kSchemes{"http", "https", "s3", "gs"};
  const std::size_t end = path.find(kSchemeEnd);
  if (end == std::string_view::npos) return false;
  return std::ranges::find(kSchemes, lower_case(path.substr(0, end))) != kSchemes.end();
}

std::string shown_url(const std::string& path) {
  if (!is_url(path)) return path;
  const UrlPieces pieces = pieces_of(path);
  return pieces.scheme + std::string(kSchemeEnd) + pieces.host + pieces.path;
}

RemoteAddress remote_address(const std::string& url) {
  const UrlPieces pieces = pieces_of(url);
  RemoteAddress address;
  address.shown = shown_url(url);
  if (pieces.host.empty()) bad_input(address.shown, "a URL with a host or a bucket", "none");
  address.server = pieces.scheme + std::string(kSchemeEnd) + pieces.host;
  address.encodes = pieces.scheme == "s3" || pieces.scheme == "gs";
  if (pieces.scheme == "s3") {
    address_s3(address, pieces.host);
  } else if (pieces.scheme == "gs") {
    address_gs(address, pieces.host);
  } else {
    address.base = pieces.scheme + std::string(kSchemeEnd) + pieces.user + pieces.host;
    address.query = pieces.query;
  }
  return address;
}

std::string RemoteAddress::request_url(const std::string& path) const {
  return base + encoded(std::string_view(path).substr(server.size()), encodes) + query;
}

}  // namespace isoweave
