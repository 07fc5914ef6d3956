// The options of remote volumes: what the environment says, and which values there are.
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"
#include "files/remote_store.hpp"

namespace isoweave {
namespace {

constexpr double kLongestTimeout = 86400;
constexpr int kMostTries = 100, kMostRequests = 256;

[[noreturn]] void wrong_value(const std::string& name, const std::string& expected, const std::string& found) {
  throw std::invalid_argument(name + ": expected " + expected + ", found " + found);
}

// The value of a variable as `parse` reads it; nothing where it is not set.
template <class Number>
void take(const char* name, std::optional<Number> (*parse)(std::string_view), const char* expected, Number& value) {
  const char* const text = std::getenv(name);
  if (text == nullptr || *text == '\0') return;
  const std::optional<Number> read = parse(text);
  if (!read) wrong_value(name, expected, in_quotes(text));
  value = *read;
}

std::optional<int> small_number(std::string_view text) {
  const std::optional<std::int64_t> number = parse_integer(text);
  return number && std::in_range<int>(*number) ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

std::optional<std::uint64_t> count(std::string_view text) {
  const std::optional<std::int64_t> number = parse_integer(text);
  return number && *number >= 0 ? std::optional(static_cast<std::uint64_t>(*number)) : std::nullopt;
}

}  // namespace

RemoteOptions remote_options() {
  RemoteOptions options;
  take("ISOWEAVE_REMOTE_TIMEOUT", parse_double, "seconds", options.timeout);
  take("ISOWEAVE_REMOTE_TRIES", small_number, "a whole number", options.tries);
  take("ISOWEAVE_REMOTE_REQUESTS", small_number, "a whole number", options.requests);
  take("ISOWEAVE_REMOTE_AHEAD", count, "a number of bytes", options.ahead);
  check_remote_options(options);
  return options;
}

void check_remote_options(const RemoteOptions& options) {
  if (!(options.timeout > 0 && options.timeout <= kLongestTimeout)) {
    wrong_value("ISOWEAVE_REMOTE_TIMEOUT", "seconds above 0, a day at most", number_text(options.timeout));
  }
  if (options.tries < 1 || options.tries > kMostTries) {
    wrong_value("ISOWEAVE_REMOTE_TRIES", "1 to " + std::to_string(kMostTries), std::to_string(options.tries));
  }
  if (options.requests < 1 || options.requests > kMostRequests) {
    wrong_value("ISOWEAVE_REMOTE_REQUESTS", "1 to " + std::to_string(kMostRequests), std::to_string(options.requests));
  }
}

}  // namespace isoweave
