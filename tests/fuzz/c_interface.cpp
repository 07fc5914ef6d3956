// Reads the input as a program in C that gives its calls anything but wild pointers: members of structs, sizes,
// samples, callbacks that fail.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "input_files.hpp"
#include "isoweave/isoweave.h"

namespace {

using isoweave::fuzz::broken_promise;

// The input, taken from the front; zeros where nothing is left.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  template <class Number>
  Number number() {
    Number value{};
    take(&value, sizeof value);
    return value;
  }

  std::uint8_t byte() { return number<std::uint8_t>(); }

  void take(void* out, std::size_t size) {
    const std::size_t there = std::min(size, left_.size());
    if (there > 0) std::memcpy(out, left_.data(), there);
    left_ = left_.subspan(there);
  }

  // One of some texts, mostly one that is understood; or none.
  const char* text() {
    constexpr const char* kTexts[] = {nullptr, "0.2vox", "0", "1mm", "-1", "nan", "0.1vox,0.5vox", "0.5,0.1", "", "7"};
    return kTexts[byte() % std::size(kTexts)];
  }

 private:
  std::span<const std::uint8_t> left_;
};

// A size that a struct may be said to have: mostly its own.
std::size_t size_like(Input& input, std::size_t size) {
  const std::uint8_t said = input.byte();
  return said < 240 ? size : said - std::size_t{240} + (said % 2) * size;
}

void expect_sane(iw_status status, const iw_result& result) {
  const bool known = (status >= IW_DONE && status <= IW_DEVICE_ERROR && status != IW_FAILED) || status == IW_STOPPED;
  if (!known) broken_promise("a status that is no fault of the library");
  if ((status == IW_DONE) != (result.message == nullptr))
    broken_promise("a message where a call fails, and only there");
  if (result.message != nullptr && std::strchr(result.message, '\n') != nullptr)
    broken_promise("a message of one line");
}

iw_volume_info volume_info(Input& input) {
  iw_volume_info info{};
  info.struct_size = size_like(input, sizeof info);
  for (std::int64_t& side : info.dims) {
    side = input.byte() % 12;
    if (side == 11) side = input.number<std::int64_t>();
  }
  info.type = input.byte() % 12;
  info.space = input.byte() % 4;
  if (input.byte() % 4 == 0) input.take(info.spacing, sizeof info.spacing);
  if (input.byte() % 4 == 0) input.take(info.origin, sizeof info.origin);
  if (input.byte() % 8 == 0) input.take(info.direction, sizeof info.direction);
  if (input.byte() % 8 == 0) info.slope = input.number<double>();
  info.unit = input.text();
  return info;
}

iw_simplify_options simplify_options(Input& input) {
  iw_simplify_options options{};
  options.struct_size = size_like(input, sizeof options);
  options.error = input.text();
  options.levels = input.byte() % 4 == 0 ? input.text() : nullptr;
  options.max_distance = input.byte() % 4 == 0 ? input.text() : nullptr;
  options.triangles = input.byte() % 4 == 0 ? input.byte() : 0;
  options.ratio = input.byte() % 8 == 0 ? input.number<double>() : 0;
  options.quality = input.byte() % 4;
  options.drop_specks = input.byte() % 2;
  options.min_component = input.byte() % 4 == 0 ? input.byte() : 0;
  options.largest = input.byte() % 4 == 0;
  return options;
}

void use_mesh(iw_mesh* mesh, iw_result* result) {
  if (mesh == nullptr) return;
  iw_mesh_arrays arrays{};
  arrays.struct_size = sizeof arrays;
  expect_sane(iw_get_mesh_arrays(mesh, &arrays, result), *result);
  for (std::uint64_t n = 0; n < 3 * arrays.triangles; ++n) {
    if (arrays.corners[n] >= arrays.vertices) broken_promise("corners that are vertices");
  }
  expect_sane(iw_check_mesh(mesh, 0, 1, result), *result);
  iw_free_mesh(mesh);
}

void mesh_anything(Input& input, const iw_volume* volume, iw_result* result) {
  const iw_simplify_options simplify = simplify_options(input);
  iw_mesh_options options{};
  options.struct_size = size_like(input, sizeof options);
  options.iso = input.byte() % 8 == 0 ? input.number<double>() : input.byte();
  options.simplify = &simplify;
  options.inside_below = input.byte() % 2;
  options.open = input.byte() % 2;
  options.smooth = input.byte() % 8 == 0 ? input.number<std::int8_t>() : 0;
  options.normals = input.byte() % 4;
  options.space = input.byte() % 5;
  options.values = input.byte() % 8 == 0 ? volume : nullptr;
  options.extractor = input.byte() % 6;
  iw_run run{};
  run.struct_size = size_like(input, sizeof run);
  run.threads = 1;
  run.slab = input.byte() % 4;
  run.checkpoint_layers = input.number<std::int8_t>();
  run.checkpoint_seconds = input.byte() % 8 == 0 ? input.number<double>() : 0;
  run.resume = input.byte() % 2;
  iw_output outputs[2]{};
  const std::size_t size = size_like(input, sizeof(iw_output));
  for (iw_output& output : outputs) {
    output.struct_size = size;
    output.label = input.text();
    output.iso = input.byte();
  }
  const std::size_t count = size == sizeof(iw_output) ? input.byte() % 3 : 1;
  const std::array calls{iw_mesh_labels, iw_mesh_isos, iw_mesh_volume, iw_mesh_volume};
  const auto call = calls[input.byte() % calls.size()];
  expect_sane(call(volume, &options, &run, outputs, count, result), *result);
  for (const iw_output& output : outputs) use_mesh(output.mesh, result);
}

// A source by callback: samples of the input over and over, until a call that fails. It expects of the library what
// isoweave.h promises to callbacks.
struct Source {
  std::span<const std::byte> samples;
  std::size_t slice_bytes = 0;
  std::int64_t slices = 0;
  std::int64_t calls = 0;               // that do not fail
  std::size_t left_out = 0;             // bytes at the end of `out` that are not written
  std::int32_t answer = 1;              // of the call that fails
  std::atomic<bool> is_called = false;  // now
};

std::int32_t read_source(void* context, std::int64_t first, std::int64_t count, void* out) {
  auto& source = *static_cast<Source*>(context);
  if (source.is_called.exchange(true)) broken_promise("one call at a time");
  if (first < 0 || count < 1 || count > source.slices - first) broken_promise("slices of the volume");
  const bool fails = source.calls-- <= 0;
  const std::size_t bytes = fails ? 0 : static_cast<std::size_t>(count) * source.slice_bytes;
  for (std::size_t n = 0; n + source.left_out < bytes; ++n) {
    static_cast<std::byte*>(out)[n] = source.samples[n % source.samples.size()];
  }
  source.is_called = false;
  return fails ? source.answer : 0;
}

constexpr std::size_t kSampleBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
constexpr std::size_t kReadable = std::size_t{1} << 16;

// The bytes of so many axes of a volume, or more than can be read.
std::size_t bytes_of(const iw_volume_info& info, std::size_t axes) {
  std::size_t bytes = kSampleBytes[info.type];
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (static_cast<std::uint64_t>(info.dims[axis]) > kReadable / bytes) return kReadable + 1;
    bytes *= static_cast<std::size_t>(info.dims[axis]);
  }
  return bytes;
}

void read_slices(Input& input, const iw_volume* volume, iw_result* result) {
  static thread_local std::byte slices[kReadable];
  const std::int64_t first = input.byte() % 4 == 0 ? input.number<std::int64_t>() : input.byte() % 4;
  const std::int64_t count = input.byte() % 4 == 0 ? input.number<std::int64_t>() : input.byte() % 4;
  expect_sane(
      iw_read_slices(volume, first, count, slices, input.byte() % 4 == 0 ? input.byte() : sizeof slices, result),
      *result);
}

// Reads a volume in all ways, and a part and a smaller one of it.
void use_volume(Input& input, const iw_volume* volume, int depth, iw_result* result) {
  iw_volume_info info{};
  info.struct_size = sizeof info;
  expect_sane(iw_get_volume_info(volume, &info, result), *result);
  read_slices(input, volume, result);
  if (bytes_of(info, 3) <= kReadable) {
    expect_sane(iw_histogram(volume, nullptr, result), *result);
    expect_sane(iw_find_labels(volume, nullptr, result), *result);
    mesh_anything(input, volume, result);
  }
  // A slice of the whole is held where a part of it, or a smaller one, is read.
  if (depth == 0 || bytes_of(info, 2) > kReadable) return;
  std::int64_t first[3], end[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = input.byte() % 8 == 0 ? input.number<std::int64_t>() : input.byte() % 4;
    end[axis] = input.byte() % 8 == 0 ? input.number<std::int64_t>() : input.byte() % 12;
  }
  iw_volume* other = nullptr;
  const bool crop = input.byte() % 2 == 0;
  expect_sane(crop ? iw_crop_volume(volume, first, end, &other, result)
                   : iw_downsample_volume(volume, first[0], &other, result),
              *result);
  if (other != nullptr) use_volume(input, other, depth - 1, result);
  iw_free_volume(other);
}

void use_source(Input& input, std::span<std::byte> samples, iw_result* result) {
  iw_volume_info info = volume_info(input);
  if (input.byte() % 8 == 0) info.dims[input.byte() % 3] = std::int64_t{1} << input.byte() % 63;
  Source context;
  context.calls = input.byte() % 4 == 0 ? input.byte() : 4096;
  context.left_out = input.byte() % 4 == 0 ? input.byte() : 0;
  context.answer = input.byte() % 4 == 0 ? input.number<std::int32_t>() | 1 : 1;
  iw_source source{};
  source.struct_size = size_like(input, sizeof source);
  source.context = &context;
  source.read = input.byte() % 64 == 0 ? nullptr : read_source;
  source.held_bytes = input.byte() % 4 == 0 ? input.number<std::uint64_t>() : input.byte();
  input.take(samples.data(), 1 + input.byte());
  context.samples = samples;
  iw_volume* volume = nullptr;
  expect_sane(iw_volume_from_source(&info, &source, &volume, result), *result);
  if (volume != nullptr) {
    info.struct_size = sizeof info;
    expect_sane(iw_get_volume_info(volume, &info, result), *result);
    context.slices = info.dims[2];
    context.slice_bytes = static_cast<std::size_t>(info.dims[0] * info.dims[1]) * kSampleBytes[info.type];
    use_volume(input, volume, 2, result);
  }
  iw_free_volume(volume);
}

void use_samples(Input& input, std::span<std::byte> samples, iw_result* result) {
  const iw_volume_info info = volume_info(input);
  std::size_t bytes = input.byte() % 4 == 0 ? input.number<std::uint16_t>() % samples.size() : 1;
  if (bytes == 1 && info.type < 10) {
    for (const std::int64_t side : info.dims) bytes *= static_cast<std::size_t>(std::clamp<std::int64_t>(side, 0, 10));
    bytes *= kSampleBytes[info.type];
  }
  input.take(samples.data(), bytes);
  iw_volume* volume = nullptr;
  expect_sane(iw_volume_in_memory(&info, samples.data(), bytes, &volume, result), *result);
  if (volume != nullptr) use_volume(input, volume, 1, result);
  iw_free_volume(volume);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  iw_result result{};
  result.struct_size = sizeof result;
  alignas(8) static thread_local std::byte samples[8 * 11 * 11 * 11];
  input.byte() % 2 == 0 ? use_samples(input, samples, &result) : use_source(input, samples, &result);
  iw_result_clear(&result);
  return 0;
}
