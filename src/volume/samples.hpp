// Typed access to samples that are held as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

inline bool is_integer(SampleType type) { return type != SampleType::kFloat32 && type != SampleType::kFloat64; }

// Calls visit.template operator()<T>() with the C++ type of the samples. Chosen once per pass, never per sample.
template <class Visitor>
decltype(auto) visit_sample_type(SampleType type, Visitor&& visit) {
  switch (type) {
    case SampleType::kUint8:
      return visit.template operator()<std::uint8_t>();
    case SampleType::kInt8:
      return visit.template operator()<std::int8_t>();
    case SampleType::kUint16:
      return visit.template operator()<std::uint16_t>();
    case SampleType::kInt16:
      return visit.template operator()<std::int16_t>();
    case SampleType::kUint32:
      return visit.template operator()<std::uint32_t>();
    case SampleType::kInt32:
      return visit.template operator()<std::int32_t>();
    case SampleType::kUint64:
      return visit.template operator()<std::uint64_t>();
    case SampleType::kInt64:
      return visit.template operator()<std::int64_t>();
    case SampleType::kFloat32:
      return visit.template operator()<float>();
    case SampleType::kFloat64:
      break;
  }
  return visit.template operator()<double>();
}

// The range of samples as stored. NaN counts in `nan` only. min > max when there is no number at all.
struct SampleRange {
  double min = 1;
  double max = 0;
  std::uint64_t nan = 0;

  bool empty() const { return min > max; }
  void merge(const SampleRange& other);
};

// Samples as numbers.
std::vector<double> numbers_of_samples(std::span<const std::byte> samples, SampleType type);

SampleRange sample_range(const std::byte* samples, SampleType type, std::int64_t count);

}  // namespace isoweave
