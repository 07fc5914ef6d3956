// A part of a volume, with samples of its trilinear interpolant between the volume's own: what stands for the surface
// of the interpolant in bench/extractors.
//
//   bench_refine VOLUME TIMES I0,J0,K0 I1,J1,K1 OUTPUT.nrrd
//
// VOLUME is a file or generate:KIND:N, of N x N x N float32 samples. The part holds samples I0 up to, not including,
// I1, and so on. TIMES is the number of new samples for each old one along an axis. Values are float64.
#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "isoweave/generate.hpp"
#include "isoweave/volume.hpp"

namespace {

using namespace isoweave;

std::unique_ptr<SliceSource> open(const std::string& name) {
  const std::string generated = "generate:";
  if (!name.starts_with(generated)) return open_volume(name);
  const std::size_t colon = name.find(':', generated.size());
  const std::int64_t size = std::stoll(name.substr(colon + 1));
  return generate_volume({.kind = name.substr(generated.size(), colon - generated.size()), .dims = {size, size, size}});
}

std::array<std::int64_t, 3> numbers(const std::string& text) {
  std::array<std::int64_t, 3> out{};
  std::size_t at = 0;
  for (std::int64_t& number : out) {
    std::size_t length = 0;
    number = std::stoll(text.substr(at), &length);
    at += length + 1;
  }
  return out;
}

template <class T>
std::vector<double> values_as(const VolumeInfo& info, const std::vector<std::byte>& bytes) {
  std::vector<T> samples(bytes.size() / sizeof(T));
  std::memcpy(samples.data(), bytes.data(), bytes.size());
  std::vector<double> values;
  values.reserve(samples.size());
  for (const T sample : samples) values.push_back(info.slope * static_cast<double>(sample) + info.intercept);
  return values;
}

std::vector<double> read_values(SliceSource& volume) {
  const VolumeInfo& info = volume.info();
  std::vector<std::byte> bytes(info.slice_bytes() * static_cast<std::size_t>(info.dims[2]));
  volume.read(0, info.dims[2], bytes);
  switch (info.type) {
    case SampleType::kUint8:
      return values_as<std::uint8_t>(info, bytes);
    case SampleType::kInt8:
      return values_as<std::int8_t>(info, bytes);
    case SampleType::kUint16:
      return values_as<std::uint16_t>(info, bytes);
    case SampleType::kInt16:
      return values_as<std::int16_t>(info, bytes);
    case SampleType::kFloat32:
      return values_as<float>(info, bytes);
    case SampleType::kFloat64:
      return values_as<double>(info, bytes);
    default:
      throw std::invalid_argument("expected 8- or 16-bit integers or floats, found " +
                                  std::string(sample_type_name(info.type)));
  }
}

// Puts values between those that follow one another along an axis.
std::vector<double> refine(const std::vector<double>& values, std::array<std::int64_t, 3>& dims, std::size_t axis,
                           std::int64_t times) {
  std::int64_t below = 1;
  for (std::size_t a = 0; a < axis; ++a) below *= dims[a];
  const std::int64_t size = dims[axis];
  const std::int64_t refined = (size - 1) * times + 1;
  const std::int64_t above = static_cast<std::int64_t>(values.size()) / (below * size);
  std::vector<double> out(static_cast<std::size_t>(below * refined * above));
  for (std::int64_t n = 0; n < above * refined; ++n) {
    const std::int64_t low = n % refined / times, part = n % refined % times;
    const double* const from = values.data() + (n / refined * size + low) * below;
    const double* const to = part > 0 ? from + below : from;
    const double t = static_cast<double>(part) / static_cast<double>(times);
    for (std::int64_t i = 0; i < below; ++i) {
      out[static_cast<std::size_t>(n * below + i)] = (1 - t) * from[i] + t * to[i];
    }
  }
  dims[axis] = refined;
  return out;
}

void run(char** arguments) {
  const auto times = std::stoll(arguments[2]);
  const auto part = crop_volume(open(arguments[1]), {numbers(arguments[3]), numbers(arguments[4])});
  VolumeInfo info = part->info();
  std::vector<double> values = read_values(*part);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    values = refine(values, info.dims, axis, times);
    info.geometry.spacing[axis] /= static_cast<double>(times);
  }
  info.type = SampleType::kFloat64;
  info.slope = 1;
  info.intercept = 0;
  write_volume(*volume_in_memory(info, std::as_bytes(std::span(values))), arguments[5]);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 6) {
    std::fputs("usage: bench_refine VOLUME TIMES I0,J0,K0 I1,J1,K1 OUTPUT.nrrd\n", stderr);
    return 2;
  }
  run(arguments);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_refine: %s\n", error.what());
  return 1;
}
