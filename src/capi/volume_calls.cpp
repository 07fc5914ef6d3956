// The calls of the C interface that open volumes and read them.
#include <array>
#include <limits>
#include <optional>
#include <string>

#include "capi/guard.hpp"
#include "capi/handles.hpp"
#include "capi/json_reports.hpp"
#include "isoweave/error.hpp"
#include "isoweave/histogram.hpp"
#include "isoweave/volume.hpp"
#include "volume/row_source.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave::capi {
namespace {

constexpr std::array<double, 9> kAxes{1, 0, 0, 0, 1, 0, 0, 0, 1};

// Slices from the caller's callback.
class CallbackSource final : public BufferedSource {
 public:
  CallbackSource(VolumeInfo info, const iw_source& source) : info_(std::move(info)), source_(source) {}

  const VolumeInfo& info() const override { return info_; }
  std::uint64_t held_bytes() const override { return source_.held_bytes; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    check_slice_range(info_, next_, first, count, out.size());
    const std::int32_t answer = count > 0 ? source_.read(source_.context, first, count, out.data()) : 0;
    if (answer != 0) throw Interrupted(info_.path + ": stopped by its source (" + std::to_string(answer) + ")");
    next_ = first + count;
  }

 private:
  const VolumeInfo info_;
  const iw_source source_;
  std::int64_t next_ = 0;
};

template <std::size_t Size>
std::array<double, Size> numbers(const double (&given)[Size], const std::array<double, Size>& usual) {
  std::array<double, Size> all{};
  std::ranges::copy(given, all.begin());
  return all == std::array<double, Size>{} ? usual : all;
}

void check_dims(const std::array<std::int64_t, 3>& dims, SampleType type, const std::string& path) {
  std::int64_t left = std::numeric_limits<std::int64_t>::max() / static_cast<std::int64_t>(sample_bytes(type));
  for (const std::int64_t size : dims) {
    if (size < 1 || size > left) {
      throw std::invalid_argument(
          path + ": expected sides of at least 1, and fewer than 2^63 bytes of samples, found " +
          std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " + std::to_string(dims[2]));
    }
    left /= size;
  }
}

VolumeInfo volume_info(const iw_volume_info& given) {
  VolumeInfo info;
  info.path = given.path == nullptr ? "volume" : given.path;
  info.format = "memory";
  std::ranges::copy(given.dims, info.dims.begin());
  if (given.type < IW_UINT8 || given.type > IW_FLOAT64)
    throw std::invalid_argument(info.path + ": expected a sample type, found " + std::to_string(given.type));
  info.type = static_cast<SampleType>(given.type);
  check_dims(info.dims, info.type, info.path);
  if (given.space < IW_SPACE_UNKNOWN || given.space > IW_SPACE_RAS)
    throw std::invalid_argument(info.path + ": expected a space, found " + std::to_string(given.space));
  info.geometry.space = static_cast<Space>(given.space);
  info.geometry.spacing = numbers(given.spacing, {1, 1, 1});
  info.geometry.origin = numbers(given.origin, {0, 0, 0});
  info.geometry.direction = numbers(given.direction, kAxes);
  info.geometry.unit = text_of(given.unit);
  info.slope = given.slope == 0 ? 1 : given.slope;
  info.intercept = given.intercept;
  return info;
}

std::optional<std::array<double, 3>> triple(const double* given) {
  if (given == nullptr) return std::nullopt;
  return std::array<double, 3>{given[0], given[1], given[2]};
}

std::optional<std::int64_t> number(const std::int64_t* given) {
  if (given == nullptr) return std::nullopt;
  return *given;
}

OpenOptions open_options(const iw_open_options& given) {
  OpenOptions options;
  if (given.raw != nullptr) options.raw = parse_raw_layout(given.raw);
  options.spacing = triple(given.spacing);
  options.origin = triple(given.origin);
  options.dataset = text_of(given.dataset);
  options.series = text_of(given.series);
  options.level = number(given.level);
  options.channel = number(given.channel);
  options.time = number(given.time);
  options.external = given.no_external == 0;
  return options;
}

void open(iw_volume** volume, VolumeOpener::Open open) {
  required(volume, "volume") = nullptr;
  *volume = new iw_volume{std::make_shared<VolumeOpener>(std::move(open))};
}

const std::atomic<bool>* wish_of(const iw_stop* stop) { return stop == nullptr ? nullptr : stop->wish.get(); }

void read_slices(const VolumeOpener& opener, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  check_slice_range(opener.info(), 0, first, count, out.size());
  opener.open()->read(first, count, out);
}

}  // namespace
}  // namespace isoweave::capi

using namespace isoweave;        // NOLINT(google-build-using-namespace): the C interface has none
using namespace isoweave::capi;  // NOLINT(google-build-using-namespace)

iw_status iw_open_volume(const char* path, const iw_open_options* options, iw_volume** volume, iw_result* result) {
  return guarded(result, [&] {
    const std::string name = &required(path, "path");
    open(volume, [name, all = open_options(taken(options))] { return open_volume(name, all); });
  });
}

iw_status iw_volume_in_memory(const iw_volume_info* info, const void* samples, size_t bytes, iw_volume** volume,
                              iw_result* result) {
  return guarded(result, [&] {
    const VolumeInfo all = volume_info(taken(&required(info, "info")));
    const std::span held(static_cast<const std::byte*>(samples), bytes);
    open(volume, [all, held] { return volume_in_memory(all, held); });
  });
}

iw_status iw_volume_from_source(const iw_volume_info* info, const iw_source* source, iw_volume** volume,
                                iw_result* result) {
  return guarded(result, [&] {
    const VolumeInfo all = volume_info(taken(&required(info, "info")));
    const iw_source given = taken(&required(source, "source"));
    if (given.read == nullptr) throw std::invalid_argument("source: expected a callback, found NULL");
    if (given.held_bytes > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      throw std::invalid_argument("source: expected held bytes below 2^63, found " + std::to_string(given.held_bytes));
    open(volume, [all, given] { return std::make_unique<CallbackSource>(all, given); });
  });
}

iw_status iw_crop_volume(const iw_volume* volume, const int64_t first[3], const int64_t end[3], iw_volume** part,
                         iw_result* result) {
  return guarded(result, [&] {
    Region region;
    std::copy_n(&required(first, "first"), 3, region.first.begin());
    std::copy_n(&required(end, "end"), 3, region.end.begin());
    open(part, [whole = required(volume, "volume").opener, region] { return crop_volume(whole->open(), region); });
  });
}

iw_status iw_downsample_volume(const iw_volume* volume, int64_t step, iw_volume** smaller, iw_result* result) {
  return guarded(result, [&] {
    open(smaller, [whole = required(volume, "volume").opener, step] { return downsample_volume(whole->open(), step); });
  });
}

iw_status iw_get_volume_info(const iw_volume* volume, iw_volume_info* info, iw_result* result) {
  return guarded(result, [&] {
    const VolumeInfo& found = required(volume, "volume").opener->info();
    iw_volume_info all{};
    std::ranges::copy(found.dims, all.dims);
    all.type = static_cast<std::int32_t>(found.type);
    all.space = static_cast<std::int32_t>(found.geometry.space);
    std::ranges::copy(found.geometry.spacing, all.spacing);
    std::ranges::copy(found.geometry.origin, all.origin);
    std::ranges::copy(found.geometry.direction, all.direction);
    all.slope = found.slope;
    all.intercept = found.intercept;
    all.unit = found.geometry.unit.c_str();
    all.path = found.path.c_str();
    hand_back(all, info);
    set_report(result, volume_json(found));
  });
}

iw_status iw_read_slices(const iw_volume* volume, int64_t first, int64_t count, void* out, size_t bytes,
                         iw_result* result) {
  return guarded(result, [&] {
    read_slices(*required(volume, "volume").opener, first, count, {static_cast<std::byte*>(out), bytes});
  });
}

iw_status iw_histogram(const iw_volume* volume, const iw_stop* stop, iw_result* result) {
  return guarded(result, [&] {
    const auto source = required(volume, "volume").opener->open();
    set_report(result, text_of(histogram_json(read_histogram(*source, wish_of(stop)))));
  });
}

iw_status iw_find_labels(const iw_volume* volume, const iw_stop* stop, iw_result* result) {
  return guarded(result, [&] {
    const auto source = required(volume, "volume").opener->open();
    set_report(result, text_of(labels_json(find_labels(*source, {}, wish_of(stop)))));
  });
}

void iw_free_volume(iw_volume* volume) { delete volume; }
