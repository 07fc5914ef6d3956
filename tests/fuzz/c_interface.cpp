// Reads the input as a program in C that gives its calls anything but wild pointers: members of structs, sizes,
// samples.
#include <algorithm>
#include <array>
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  iw_result result{};
  result.struct_size = sizeof result;
  const iw_volume_info info = volume_info(input);
  alignas(8) static thread_local std::byte samples[8 * 11 * 11 * 11];
  std::size_t bytes = input.byte() % 4 == 0 ? input.number<std::uint16_t>() % sizeof samples : 1;
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  if (bytes == 1 && info.type < 10) {
    for (const std::int64_t side : info.dims) bytes *= static_cast<std::size_t>(std::clamp<std::int64_t>(side, 0, 10));
    bytes *= kSizes[info.type];
  }
  input.take(samples, bytes);
  iw_volume* volume = nullptr;
  expect_sane(iw_volume_in_memory(&info, samples, bytes, &volume, &result), result);
  if (volume != nullptr) {
    expect_sane(iw_histogram(volume, nullptr, &result), result);
    expect_sane(iw_find_labels(volume, nullptr, &result), result);
    mesh_anything(input, volume, &result);
  }
  iw_free_volume(volume);
  iw_result_clear(&result);
  return 0;
}
