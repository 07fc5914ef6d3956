#include "pipeline/memory_cap.hpp"

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kKilo = 1'000;
constexpr std::uint64_t kMega = 1'000'000;
constexpr std::uint64_t kSlack = 5 * kMega;  // and two fifths

}  // namespace

std::uint64_t with_slack(std::uint64_t least) { return least + least / 5 * 2 + kSlack; }

std::uint64_t without_slack(std::uint64_t named) { return named <= kSlack ? 0 : (named - kSlack) / 7 * 5; }

std::uint64_t whole_cap(std::uint64_t bytes) { return (bytes / kMega + (bytes % kMega > 0 ? 1 : 0)) * kMega; }

std::string cap_text(std::uint64_t bytes) {
  if (bytes % kMega == 0) return std::to_string(bytes / kMega) + "M";
  if (bytes % kKilo == 0) return std::to_string(bytes / kKilo) + "K";
  return std::to_string(bytes);
}

void refuse_cap(const std::string& where, std::uint64_t least, std::uint64_t cap, const std::string& more) {
  throw OverMemory(where + ": expected --memory " + cap_text(whole_cap(least)) + " or more, found " + cap_text(cap) +
                   more);
}

}  // namespace isoweave
