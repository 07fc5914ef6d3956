#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "isoweave/volume.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

class HeldVolume final : public SliceSource {
 public:
  HeldVolume(const VolumeInfo& info, std::span<const std::byte> samples) : info_(info), samples_(samples) {}

  const VolumeInfo& info() const override { return info_; }
  std::span<const std::byte> held() const override { return samples_; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    check_slice_range(info_, next_, first, count, out.size());
    const std::size_t slice = info_.slice_bytes();
    std::memcpy(out.data(), samples_.data() + static_cast<std::size_t>(first) * slice,
                static_cast<std::size_t>(count) * slice);
    next_ = first + count;
  }

 private:
  const VolumeInfo info_;
  const std::span<const std::byte> samples_;
  std::int64_t next_ = 0;
};

}  // namespace

std::unique_ptr<SliceSource> volume_in_memory(const VolumeInfo& info, std::span<const std::byte> samples) {
  const std::size_t bytes = sample_bytes(info.type);
  const auto refuse = [&](const std::string& expected, const std::string& found) {
    throw std::invalid_argument(info.path + ": expected " + expected + ", found " + found);
  };
  std::uint64_t left = samples.size();
  bool fits = left % bytes == 0;
  left /= bytes;
  for (const std::int64_t size : info.dims) {
    fits = fits && size > 0 && left % static_cast<std::uint64_t>(size) == 0;
    if (fits) left /= static_cast<std::uint64_t>(size);
  }
  if (!fits || left != 1) {
    refuse(std::to_string(info.dims[0]) + " x " + std::to_string(info.dims[1]) + " x " + std::to_string(info.dims[2]) +
               " samples of " + std::to_string(bytes) + " bytes",
           std::to_string(samples.size()) + " bytes");
  }
  if (reinterpret_cast<std::uintptr_t>(samples.data()) % bytes != 0) {
    refuse("samples at a multiple of " + std::to_string(bytes) + " bytes", "another address");
  }
  return std::make_unique<HeldVolume>(info, samples);
}

}  // namespace isoweave
