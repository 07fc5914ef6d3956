#include "volume/scaled_stream.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "parallel/size.hpp"
#include "volume/samples.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

SampleType type_of_values(SampleType stored) {
  const bool exact = sample_bytes(stored) <= 2 || stored == SampleType::kFloat32;
  return exact ? SampleType::kFloat32 : SampleType::kFloat64;
}

ScaledStream::ScaledStream(std::unique_ptr<ByteStream> stored, const VolumeInfo& info, bool swap_bytes,
                           AxisScaling scaling)
    : stored_(std::move(stored)),
      dims_(info.dims),
      type_(info.type),
      swap_(swap_bytes),
      scaling_(std::move(scaling)),
      samples_(info.slice_bytes()),
      values_(to_size(info.slice_samples(), sample_bytes(type_of_values(info.type)))) {}

template <class Sample, class Value>
void ScaledStream::convert() {
  std::size_t n = 0;
  std::array<std::int64_t, 3> at{0, 0, slice_};
  for (at[1] = 0; at[1] < dims_[1]; ++at[1]) {
    for (at[0] = 0; at[0] < dims_[0]; ++at[0], ++n) {
      Sample sample;
      std::memcpy(&sample, samples_.data() + n * sizeof sample, sizeof sample);
      const auto index = static_cast<std::size_t>(at.at(scaling_.axis));
      const auto value =
          static_cast<Value>(scaling_.slope[index] * static_cast<double>(sample) + scaling_.intercept[index]);
      std::memcpy(values_.data() + n * sizeof value, &value, sizeof value);
    }
  }
}

// Converts the slice that is read from. Returns false where the stored samples end.
bool ScaledStream::at_slice() {
  if (slice_ == dims_[2]) return false;
  if (converted_) return true;
  if (stored_->read(samples_) < samples_.size()) return false;
  if (swap_) swap_sample_bytes(samples_, sample_bytes(type_));
  const bool single = type_of_values(type_) == SampleType::kFloat32;
  visit_sample_type(type_, [&]<class Sample>() { single ? convert<Sample, float>() : convert<Sample, double>(); });
  converted_ = true;
  return true;
}

std::size_t ScaledStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && at_slice()) {
    const std::size_t count = std::min(out.size() - done, values_.size() - used_);
    std::memcpy(out.data() + done, values_.data() + used_, count);
    done += count;
    used_ += count;
    if (used_ < values_.size()) break;
    used_ = 0;
    converted_ = false;
    ++slice_;
  }
  return done;
}

// Whole slices need not be converted.
std::uint64_t ScaledStream::skip(std::uint64_t count) {
  std::uint64_t done = 0;
  while (done < count && used_ == 0 && !converted_ && slice_ < dims_[2] && count - done >= values_.size()) {
    if (stored_->skip(samples_.size()) < samples_.size()) return done;
    done += values_.size();
    ++slice_;
  }
  return done < count ? done + ByteStream::skip(count - done) : done;
}

}  // namespace isoweave
