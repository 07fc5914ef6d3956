// HDF5: one dataset of a file is the volume. libhdf5 reads a band of slices at a time, as deep as the dataset's chunks.
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <utility>

#include "files/length_units.hpp"
#include "files/quoted.hpp"
#include "files/whole_input.hpp"
#include "volume/axes.hpp"
#include "volume/band_stream.hpp"
#include "volume/formats/chunked/array_values.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/hdf5/hdf5_dataset.hpp"
#include "volume/formats/hdf5/hdf5_place.hpp"
#include "volume/formats/hdf5/hdf5_scales.hpp"
#include "volume/scaled_stream.hpp"

namespace isoweave {
namespace {

constexpr unsigned kReadOnly = 0;  // H5F_ACC_RDONLY

// A file and one of its datasets.
struct OpenDataset {
  Hdf5Handle file;
  Hdf5Handle dataset;
};

class DatasetStream final : public BandStream {
 public:
  // `chunk`: the samples of a chunk along each axis of the dataset; empty where samples lie in one piece.
  DatasetStream(std::string path, OpenDataset open, const VolumeInfo& info, AxisChoice choice, std::int64_t depth,
                std::vector<std::int64_t> chunk, std::shared_ptr<Gaps> gaps)
      : BandStream(info.dims[2], info.slice_bytes(), depth),
        chunk_(std::move(chunk)),
        gaps_(std::move(gaps)),
        path_(std::move(path)),
        open_(std::move(open)),
        dims_(info.dims),
        bytes_each_(sample_bytes(info.type)),
        choice_(std::move(choice)) {}

  ~DatasetStream() override {
    const Hdf5Session session(path_);
    open_.dataset.reset();
    open_.file.reset();
  }
  DatasetStream(const DatasetStream&) = delete;
  DatasetStream& operator=(const DatasetStream&) = delete;

 protected:
  void fill(std::int64_t first, std::int64_t count, std::span<std::byte> band) override {
    std::vector<hsize_t> begin(choice_.at.begin(), choice_.at.end());
    std::vector<hsize_t> size(begin.size(), 1);
    for (std::size_t a = 0; a < dims_.size(); ++a) {
      if (choice_.axis.at(a) == kNoAxis) continue;
      begin[choice_.axis.at(a)] = a == 2 ? static_cast<hsize_t>(first) : 0;
      size[choice_.axis.at(a)] = static_cast<hsize_t>(a == 2 ? count : dims_.at(a));
    }
    if (in_order()) return read_slab(begin, size, band);
    // Samples come in the order of the dataset's axes.
    turned_.resize(band.size());
    read_slab(begin, size, turned_);
    BlockCopy copy;
    copy.size = {dims_[0], dims_[1], count};
    copy.to_step = {1, dims_[0], dims_[0] * dims_[1]};
    for (std::size_t a = 0; a < dims_.size(); ++a) {
      std::int64_t step = 1;
      for (std::size_t n = choice_.axis.at(a) + 1; n < size.size() && choice_.axis.at(a) != kNoAxis; ++n) {
        step *= static_cast<std::int64_t>(size[n]);
      }
      copy.from_step.at(a) = step;
    }
    copy_block(turned_.data(), band.data(), copy, bytes_each_);
  }

 private:
  // Whether the dataset's axes are k, j, i in this order.
  bool in_order() const {
    const auto& [i, j, k] = choice_.axis;
    return j < i && (k == kNoAxis || k < j);
  }

  // Reads the samples of a box of the dataset, or, where some of its chunks are not needed, the others.
  void read_slab(const std::vector<hsize_t>& begin, const std::vector<hsize_t>& size, std::span<std::byte> out) {
    const Hdf5Session session(path_);
    const Hdf5Functions& h5 = session.h5();
    // Samples are read as they are stored: nothing is converted.
    const Hdf5Handle type(h5.dget_type(open_.dataset.id()), h5.tclose);
    const Hdf5Handle from(h5.dget_space(open_.dataset.id()), h5.sclose);
    const Hdf5Handle to(h5.screate_simple(static_cast<int>(size.size()), size.data(), nullptr), h5.sclose);
    // A type of another size would not fit the memory.
    const bool ready = type && from && to && h5.tget_size(type.id()) == bytes_each_;
    const auto read = [&](const std::vector<hsize_t>& first, const std::vector<hsize_t>& count) {
      std::vector<hsize_t> place(first.size());
      for (std::size_t n = 0; n < first.size(); ++n) place[n] = first[n] - begin[n];
      return h5.sselect_hyperslab(from.id(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr) >= 0 &&
             h5.sselect_hyperslab(to.id(), H5S_SELECT_SET, place.data(), nullptr, count.data(), nullptr) >= 0 &&
             h5.dread(open_.dataset.id(), type.id(), to.id(), from.id(), kDefaultProperties, out.data()) >= 0;
    };
    const bool whole = chunk_.empty() || gaps_->needed == nullptr;
    const bool done = ready && (whole ? read(begin, size) : read_chunks(begin, size, read));
    if (!done) session.refuse(path_, "samples that libhdf5 can read");
  }

  // Calls read(first, count) for the part of each needed chunk in a box of the dataset, until it returns false.
  template <class Read>
  bool read_chunks(const std::vector<hsize_t>& begin, const std::vector<hsize_t>& size, const Read& read) {
    std::vector<hsize_t> first = begin;
    while (true) {
      std::vector<hsize_t> count(first.size());
      for (std::size_t n = 0; n < first.size(); ++n) {
        const auto step = static_cast<hsize_t>(chunk_[n]);
        count[n] = std::min((first[n] / step + 1) * step, begin[n] + size[n]) - first[n];
      }
      if (!gaps_->leaves_out(box_of(first, count)) && !read(first, count)) return false;
      std::size_t axis = first.size();
      while (axis > 0 && (first[axis - 1] += count[axis - 1]) == begin[axis - 1] + size[axis - 1]) {
        --axis;
        first[axis] = begin[axis];
      }
      if (axis == 0) return true;
    }
  }

  // A box of the dataset as one of the volume.
  Region box_of(const std::vector<hsize_t>& first, const std::vector<hsize_t>& count) const {
    Region box{{0, 0, 0}, {1, 1, 1}};
    for (std::size_t a = 0; a < dims_.size(); ++a) {
      const std::size_t axis = choice_.axis.at(a);
      if (axis == kNoAxis) continue;
      box.first.at(a) = static_cast<std::int64_t>(first[axis]);
      box.end.at(a) = static_cast<std::int64_t>(first[axis] + count[axis]);
    }
    return box;
  }

  std::vector<std::int64_t> chunk_;
  std::shared_ptr<Gaps> gaps_;
  std::string path_;
  OpenDataset open_;
  std::array<std::int64_t, 3> dims_;
  std::size_t bytes_each_;
  AxisChoice choice_;
  std::vector<std::byte> turned_;
};

std::string text_of(const Hdf5Dataset& dataset) {
  std::string text = in_quotes(dataset.name) + " (";
  for (std::size_t n = 0; n < dataset.shape.size(); ++n)
    text += (n == 0 ? "" : " x ") + std::to_string(dataset.shape[n]);
  return text + " " + dataset.type_text + ")";
}

constexpr std::string_view kReadTypes = "integers of 8 to 64 bits or floats of 16 to 64 bits";

// The end of a message about what a file holds.
std::string links_out_text(const Hdf5Contents& contents) {
  if (contents.link_out.empty()) return {};
  return "; links into other files, such as " + in_quotes(contents.link_out) + ", are not followed";
}

// The one that is taken when none is named: the only one of three axes or more whose samples can be read.
std::string only_dataset(const Hdf5Contents& contents, const std::string& path) {
  constexpr std::size_t kMostNamed = 12;
  const std::vector<Hdf5Dataset>& found = contents.datasets;
  std::vector<const Hdf5Dataset*> volumes, unread;
  for (const Hdf5Dataset& dataset : found) {
    if (dataset.shape.size() > 2) (dataset.type ? volumes : unread).push_back(&dataset);
  }
  if (volumes.size() == 1) return volumes[0]->name;
  if (volumes.empty() && unread.size() == 1) {
    bad_input(path, std::string(kReadTypes) + " in " + in_quotes(unread[0]->name), unread[0]->type_text);
  }
  std::string listed;
  for (std::size_t n = 0; n < std::min(found.size(), kMostNamed); ++n)
    listed += (n == 0 ? "" : ", ") + text_of(found[n]);
  if (found.size() > kMostNamed) listed += " and " + std::to_string(found.size() - kMostNamed) + " more";
  if (found.empty()) bad_input(path, "a dataset of numbers of 2 axes or more", "none" + links_out_text(contents));
  bad_input(path, "--dataset with one of " + listed, "no choice");
}

std::string filter_name(H5Z_filter_t filter, const char* stored) {
  static constexpr std::array<std::pair<int, std::string_view>, 9> kNames{{{1, "gzip"},
                                                                           {4, "szip"},
                                                                           {32000, "lzf"},
                                                                           {32001, "blosc"},
                                                                           {32004, "lz4"},
                                                                           {32008, "bitshuffle"},
                                                                           {32013, "zfp"},
                                                                           {32015, "zstd"},
                                                                           {32026, "blosc2"}}};
  for (const auto& [number, name] : kNames) {
    if (number == filter) return std::string(name);
  }
  return std::string(stored) + " (number " + std::to_string(filter) + ")";
}

void check_filters(const Hdf5Session& session, hid_t properties, const std::string& path) {
  const Hdf5Functions& h5 = session.h5();
  const int filters = h5.pget_nfilters(properties);
  for (int n = 0; n < filters; ++n) {
    std::array<char, 64> name{};
    std::size_t values = 0;
    unsigned flags = 0, config = 0;
    const H5Z_filter_t filter = h5.pget_filter2(properties, static_cast<unsigned>(n), &flags, &values, nullptr,
                                                name.size() - 1, name.data(), &config);
    if (filter < 0) session.refuse(path, "the filters of the dataset");
    if (h5.zfilter_avail(filter) > 0) continue;
    bad_input(path, "a filter that libhdf5 or one of its plugins has", filter_name(filter, name.data()));
  }
}

// How a dataset is stored: samples per chunk along each axis, or none.
std::vector<std::int64_t> chunks_of(const Hdf5Session& session, hid_t dataset, std::size_t axes,
                                    const std::string& path) {
  const Hdf5Functions& h5 = session.h5();
  const Hdf5Handle properties(h5.dget_create_plist(dataset), h5.pclose);
  if (!properties) session.refuse(path, "the layout of the dataset");
  if (layout_in_file(session, dataset, path) != H5D_CHUNKED) return {};
  check_filters(session, properties.id(), path);
  std::array<hsize_t, H5S_MAX_RANK> sizes{};
  const int rank = h5.pget_chunk(properties.id(), static_cast<int>(sizes.size()), sizes.data());
  if (rank != static_cast<int>(axes)) session.refuse(path, "chunks of the dataset's axes");
  std::vector<std::int64_t> chunk;
  for (std::size_t n = 0; n < axes; ++n) chunk.push_back(static_cast<std::int64_t>(sizes.at(n)));
  return chunk;
}

// Chunks may be left out and compressed, so that any size may be claimed: what is held must be in some proportion to
// what is stored.
void check_stored(const VolumeInfo& info, std::uint64_t stored, std::uint64_t file_bytes, std::int64_t depth,
                  const std::vector<std::int64_t>& chunk) {
  constexpr std::uint64_t kRatio = 1 << 20;
  if (stored > file_bytes) {
    bad_input(info.path, std::to_string(stored) + " bytes of samples", "a file of " + std::to_string(file_bytes));
  }
  std::uint64_t held = 0;
  bool overflow = __builtin_mul_overflow(static_cast<std::uint64_t>(depth), info.slice_bytes(), &held);
  std::uint64_t chunk_bytes = sample_bytes(info.type);
  for (const std::int64_t size : chunk) {
    overflow = overflow || __builtin_mul_overflow(chunk_bytes, static_cast<std::uint64_t>(size), &chunk_bytes);
  }
  if (overflow) bad_input(info.path, "chunks and bands of fewer than 2^63 bytes", "larger ones");
  check_plausible(info.path, std::max(held, chunk_bytes), file_bytes, kRatio);
  if (chunk.empty() && stored > 0) check_plausible(info.path, checked_volume_bytes(info), stored, 1);
}

std::int64_t band_depth(const VolumeInfo& info, const AxisChoice& choice, const std::vector<std::int64_t>& chunk) {
  constexpr std::int64_t kPlainBand = 4 << 20;
  if (choice.axis[2] == kNoAxis) return 1;
  if (chunk.empty())
    return std::clamp<std::int64_t>(kPlainBand / static_cast<std::int64_t>(info.slice_bytes()), 1, info.dims[2]);
  return std::min(chunk[choice.axis[2]], info.dims[2]);
}

// The dataset that is read, and what a format says of it.
struct FoundDataset {
  std::string name;
  std::optional<Hdf5Place> place;
  std::vector<AxisCoordinates> coordinates;
  std::vector<std::string> notes;
};

FoundDataset find_dataset(const Hdf5File& file, const OpenOptions& options) {
  FoundDataset found;
  found.name = options.dataset;
  if (!found.name.empty() && !found.name.starts_with('/')) found.name.insert(0, "/");
  found.place = find_hdf5_place(file, found.name, options);
  if (found.place) {
    found.name = found.place->dataset;
    found.notes = found.place->notes;
  } else if (found.name.empty()) {
    const Hdf5Contents contents = find_datasets(file.session, file.id, file.path);
    found.name = only_dataset(contents, file.path);
    found.notes.push_back(in_quotes(found.name) + " is the only dataset of 3 axes or more, and is read" +
                          links_out_text(contents));
    found.place = find_hdf5_place(file, found.name, options);
    if (found.place) found.notes.insert(found.notes.end(), found.place->notes.begin(), found.place->notes.end());
  }
  const bool chosen = found.place && found.place->chosen;
  if (options.level && !chosen) bad_input(file.path, "an image of several levels for --level", "HDF5");
  return found;
}

// The axes of a dataset that no format describes, by its attributes and scales.
std::vector<ArrayAxis> plain_axes(const Hdf5File& file, hid_t id, const Hdf5Dataset& dataset, FoundDataset& found) {
  std::vector<ArrayAxis> axes;
  for (const std::int64_t size : dataset.shape) axes.push_back({size, {}});
  name_hdf5_axes(hdf5_attributes(file.session, id), axes);
  Hdf5Scales scales = take_hdf5_scales(file, id, found.name, axes);
  found.coordinates = std::move(scales.coordinates);
  found.notes.insert(found.notes.end(), scales.notes.begin(), scales.notes.end());
  return axes;
}

// The axes of a dataset with the names of a format; those of a padded one end where its samples that count end.
std::vector<ArrayAxis> axes_of(const Hdf5Dataset& dataset, const FoundDataset& found, const std::string& path) {
  std::vector<ArrayAxis> axes;
  for (const std::int64_t size : dataset.shape) axes.push_back({size, {}});
  const std::vector<std::string>& names = found.place->axis_names;
  if (names.size() != axes.size()) {
    bad_input(path, std::to_string(names.size()) + " axes in " + in_quotes(found.name), std::to_string(axes.size()));
  }
  for (std::size_t n = 0; n < axes.size(); ++n) {
    axes[n].name = names[n];
    if (found.place->shape.empty()) continue;
    if (found.place->shape[n] > axes[n].size) {
      bad_input(path, std::to_string(found.place->shape[n]) + " samples along " + names[n],
                std::to_string(axes[n].size));
    }
    axes[n].size = found.place->shape[n];
  }
  return axes;
}

void take_place(OpenedVolume& volume, const Hdf5Place& place) {
  VolumeInfo& info = volume.info;
  const CommonUnit unit = common_unit({place.units[0], place.units[1], place.units[2]});
  Axes axes = place.axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (double& component : axes.steps[axis]) component *= unit.scale[axis];
    axes.origin[axis] *= unit.scale[axis];
  }
  set_geometry(info.geometry, axes, info.path);
  take_unit(volume, unit);
  info.geometry.space = place.space;
}

// The scaling of the chosen samples along the one axis of the volume that it may change along.
AxisScaling scaling_of(const Hdf5Place& place, const std::vector<ArrayAxis>& axes, const AxisChoice& choice,
                       const std::string& path) {
  AxisScaling scaling;
  std::int64_t first = 0, step = 0, stride = 1, count = 1;
  for (std::size_t n = place.scaled_axes; n-- > 0; stride *= axes[n].size) {
    const auto found = std::find(choice.axis.begin(), choice.axis.end(), n);
    if (found == choice.axis.end()) {
      first += choice.at[n] * stride;
    } else if (count > 1) {
      bad_input(path, "a scaling that changes along one axis", "one that changes along two");
    } else {
      scaling.axis = static_cast<std::size_t>(found - choice.axis.begin());
      step = stride;
      count = axes[n].size;
    }
  }
  for (std::int64_t n = 0; n < count; ++n) {
    scaling.slope.push_back(place.slope[static_cast<std::size_t>(first + n * step)]);
    scaling.intercept.push_back(place.intercept[static_cast<std::size_t>(first + n * step)]);
  }
  return scaling;
}

// Scales the samples. A scaling that all samples share stays with the volume; with one that changes, samples are read
// as values.
void scale_samples(OpenedVolume& volume, AxisScaling scaling) {
  VolumeInfo& info = volume.info;
  const auto varies = [](const std::vector<double>& list) {
    return std::adjacent_find(list.begin(), list.end(), std::not_equal_to<>()) != list.end();
  };
  if (!varies(scaling.slope) && !varies(scaling.intercept) && scaling.slope.front() != 0) {
    info.slope = scaling.slope.front();
    info.intercept = scaling.intercept.front();
    return;
  }
  const std::size_t axis = scaling.axis;
  volume.samples = std::make_unique<ScaledStream>(std::move(volume.samples), info,
                                                  std::exchange(volume.swap_bytes, false), std::move(scaling));
  info.type = type_of_values(info.type);
  info.notes.push_back("the scaling changes along axis " + std::to_string(axis) + ": samples are read as values, in " +
                       std::string(sample_type_name(info.type)));
  checked_volume_bytes(info);
}

OpenedVolume describe_volume(const Hdf5Dataset& dataset, const FoundDataset& found, const ArrayAttributes& attributes,
                             const std::vector<ArrayAxis>& axes, const AxisChoice& choice, const std::string& path) {
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = path;
  info.format = "hdf5";
  info.type = dataset.type->type;
  info.dims = choice.dims(axes);
  info.part = "dataset " + found.name;
  for (const std::string& part : {found.place ? found.place->part : std::string(), choice.part}) {
    if (!part.empty()) info.part += ", " + part;
  }
  info.notes = found.notes;
  info.notes.insert(info.notes.end(), choice.notes.begin(), choice.notes.end());
  checked_volume_bytes(info);
  if (found.place) {
    take_place(volume, *found.place);
  } else {
    AxisPlaces places = places_of_attributes(attributes, choice);
    take_offset(places, attributes, choice);
    take_coordinates(places, found.coordinates, axes, choice);
    place_axes(volume, choice, places);
  }
  if (!found.place || !found.place->has_values) take_values(info, attributes);
  volume.swap_bytes = dataset.big_endian != (std::endian::native == std::endian::big);
  return volume;
}

}  // namespace

OpenedVolume open_hdf5(const FilePtr& file, const OpenOptions& options) {
  const std::string& path = file->path();
  const Hdf5Session session(path);
  const Hdf5Functions& h5 = session.h5();
  OpenDataset open;
  open.file = Hdf5Handle(h5.fopen(FileName(*file).text().c_str(), kReadOnly, kDefaultProperties), h5.fclose);
  if (!open.file) session.refuse(path, "a readable HDF5 file");
  FoundDataset found = find_dataset({session, open.file.id(), path}, options);
  open.dataset = session.open_object(open.file.id(), found.name, path);
  if (!open.dataset) session.refuse(path, "a dataset " + in_quotes(found.name));
  if (h5.iget_type(open.dataset.id()) != H5I_DATASET) {
    bad_input(path, "a dataset " + in_quotes(found.name), "a group");
  }
  layout_in_file(session, open.dataset.id(), path);
  const Hdf5Dataset dataset = describe_dataset(session, open.dataset.id(), found.name);
  if (!dataset.type) {
    bad_input(path, std::string(kReadTypes) + " in " + in_quotes(found.name), dataset.type_text);
  }
  const ArrayAttributes attributes = hdf5_attributes(session, open.dataset.id());
  const std::vector<ArrayAxis> axes =
      found.place ? axes_of(dataset, found, path)
                  : plain_axes({session, open.file.id(), path}, open.dataset.id(), dataset, found);
  OpenOptions left = options;
  if (found.place && found.place->chosen) left.channel = left.time = std::nullopt;
  const AxisChoice choice = choose_axes(axes, left, path);
  OpenedVolume volume = describe_volume(dataset, found, attributes, axes, choice, path);
  const std::vector<std::int64_t> chunk = chunks_of(session, open.dataset.id(), axes.size(), path);
  const std::int64_t depth = band_depth(volume.info, choice, chunk);
  check_stored(volume.info, h5.dget_storage_size(open.dataset.id()), file->size(), depth, chunk);
  volume.held_bytes = 2 * static_cast<std::uint64_t>(depth) * volume.info.slice_bytes();
  if (!chunk.empty()) volume.gaps = std::make_shared<Gaps>();
  volume.samples =
      std::make_unique<DatasetStream>(path, std::move(open), volume.info, choice, depth, chunk, volume.gaps);
  if (dataset.type->is_half) read_halves(volume);
  if (found.place && !found.place->slope.empty()) {
    scale_samples(volume, scaling_of(*found.place, axes, choice, path));
  }
  return volume;
}

}  // namespace isoweave
