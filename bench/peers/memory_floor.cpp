// No extraction: every sample is read once by all threads. Nothing that looks at all samples can take less.
#include <atomic>
#include <cstdint>
#include <cstring>
#include <span>
#include <thread>

#include "task.hpp"

namespace bench {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

// Keeps the compiler from leaving the reading out.
std::uint64_t combined(std::span<const std::byte> samples) {
  std::uint64_t all = 0;
  for (std::size_t at = 0; at + kWord <= samples.size(); at += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, samples.data() + at, kWord);
    all ^= word;
  }
  return all;
}

class MemoryFloor : public Task {
 public:
  MemoryFloor(const HeldVolume& volume, const Goal& goal)
      : samples_(volume.samples), threads_(static_cast<std::size_t>(goal.threads)) {}
  void run() override {
    const auto part = [&](std::size_t t) {
      const std::size_t begin = samples_.size() * t / threads_, end = samples_.size() * (t + 1) / threads_;
      combined_ ^= combined(samples_.subspan(begin, end - begin));
    };
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < threads_; ++t) others.emplace_back(part, t);
    part(0);
  }
  std::size_t triangles() const override { return 0; }
  isoweave::TriangleMesh mesh() const override { return {}; }

 private:
  std::span<const std::byte> samples_;
  std::size_t threads_;
  std::atomic<std::uint64_t> combined_ = 0;
};

}  // namespace

void add_memory_floor(Contestants& contestants) {
  contestants.extractors.push_back({"every sample read once", true, [](const HeldVolume& volume, const Goal& goal) {
                                      return std::make_unique<MemoryFloor>(volume, goal);
                                    }});
}

}  // namespace bench
