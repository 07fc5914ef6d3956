// Samples whose scaling changes along one axis: read as values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "files/byte_stream.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

// value = slope * sample + intercept, by the index of a sample along `axis`.
struct AxisScaling {
  std::size_t axis = 2;  // i, j or k
  std::vector<double> slope;
  std::vector<double> intercept;
};

// The type that values of samples of a type are given in: float32 where that holds the samples, else float64.
SampleType type_of_values(SampleType stored);

// Slices of stored samples, in the byte order of the file, as slices of values. Holds one slice of each.
class ScaledStream final : public ByteStream {
 public:
  ScaledStream(std::unique_ptr<ByteStream> stored, const VolumeInfo& info, bool swap_bytes, AxisScaling scaling);

  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t skip(std::uint64_t count) override;
  bool skips() const override { return stored_->skips(); }

 private:
  bool at_slice();
  template <class Sample, class Value>
  void convert();

  std::unique_ptr<ByteStream> stored_;
  std::array<std::int64_t, 3> dims_;
  SampleType type_;
  bool swap_;
  AxisScaling scaling_;
  std::vector<std::byte> samples_;
  std::vector<std::byte> values_;
  std::int64_t slice_ = 0;
  std::size_t used_ = 0;  // bytes of the slice
  bool converted_ = false;
};

}  // namespace isoweave
