// Volumes: regular grids of scalar samples, handed out slice by slice.
//
// Samples are f[k][j][i], i fastest. Slice k is one plane of nx * ny samples. Slices are read in increasing k, once, so
// a compressed stream serves as well as a file on disk. The memory of a source is bounded by the slices asked for plus
// a small constant, never by the volume.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/label.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Integers of 64 bits are compared as they are. A number made of one (the place of a surface, a mean, the range in a
// report) is rounded to a double beyond 2^53.
enum class SampleType : std::uint8_t {
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat32,
  kFloat64
};

// The size of one sample in bytes.
std::size_t sample_bytes(SampleType type);

// The name of a type: "uint8", "int16", "float32", ...
std::string_view sample_type_name(SampleType type);

// The inverse of sample_type_name; nothing if the name is unknown.
std::optional<SampleType> parse_sample_type(std::string_view name);

// The meaning of the world axes: LPS (DICOM, ITK: left, posterior, superior) or RAS (NIfTI, FreeSurfer).
enum class Space : std::uint8_t { kUnknown, kLps, kRas };

// The name of a space: "lps", "ras", "unknown".
std::string_view space_name(Space space);

// The place of samples in the world: position(i, j, k) = origin + direction * (spacing * (i, j, k)).
struct Geometry {
  std::array<double, 3> spacing{1, 1, 1};                      // > 0, finite
  std::array<double, 3> origin{0, 0, 0};                       // of sample (0, 0, 0)
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major; column a is axis a, unit length
  Space space = Space::kUnknown;
  std::string unit;  // "mm", "um", "nm", "m", or empty: not said, and millimetres wherever a length needs a unit
};

struct VolumeInfo {
  std::string path;                           // as given
  std::string format;                         // "raw", "nrrd", "metaimage", "nifti", "pvm", "tiff", "png", "dicom", ...
  std::string part;                           // the chosen part of it: "dataset /raw, channel 1"; empty: all of it
  std::string header;                         // where `path` is a folder: the file that describes the volume, if any
  std::vector<std::string> data_files;        // files with samples, where they are not all in `path` or its folder
  std::string layout;                         // of headerless data, as parse_raw_layout takes it
  std::array<std::int64_t, 3> dims{0, 0, 0};  // nx, ny, nz; each >= 1; the product fits in 63 bits
  SampleType type = SampleType::kUint8;
  Geometry geometry;
  double slope = 1;                    // value = slope * stored + intercept; slope is not 0
  double intercept = 0;                // iso-values are given as values, samples stay as stored
  std::vector<LabelName> labels;       // what the file says of labels, in its order (segmentations)
  std::vector<std::string> notes;      // things a user should know: "4-D: the first of 12 volumes is read"
  std::vector<std::string> remarks{};  // the same of what is usual: "1 file of the folder is no slice ...: README.md"

  std::int64_t slice_samples() const { return dims[0] * dims[1]; }
  // @throws std::length_error for a slice larger than memory can be
  std::size_t slice_bytes() const {
    const std::uint64_t bytes = static_cast<std::uint64_t>(slice_samples()) * sample_bytes(type);
    if (bytes > std::numeric_limits<std::size_t>::max())
      throw std::length_error("a slice of more bytes than memory has");
    return static_cast<std::size_t>(bytes);
  }
};

// A volume being read. Not thread-safe. Runs with more than one thread read it in a thread of their own.
class SliceSource {
 public:
  virtual ~SliceSource() = default;

  virtual const VolumeInfo& info() const = 0;

  // Reads slices [first, first + count) into `out`, in the machine's byte order, densely packed.
  // @pre `first` is not before the end of the previous call; slices in between are skipped. `out` holds at least count
  //   * slice_bytes() bytes.
  // @throws BadInput when the data end early, are corrupt or cannot be read; std::invalid_argument for a range outside
  //   the volume or behind
  virtual void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) = 0;

  // Whether skipping slices costs next to nothing. It does not in a compressed stream.
  virtual bool skips() const { return true; }

  // Whether a part of a row costs next to nothing but its own samples. So it is where samples lie in a file or in
  // memory as they are, and not where rows are computed, or are parts of chunks that must be decoded.
  virtual bool reads_parts_of_rows() const { return !held().empty(); }

  // Whether a box of samples (crop_volume) costs little more than its own samples: those of the chunks that it touches,
  // and memory for its own slices.
  virtual bool reads_boxes() const { return reads_parts_of_rows(); }

  // All slices as read() gives them, if the source has them in memory anyway, else nothing. A run uses such slices
  // where they are, and reads no others.
  virtual std::span<const std::byte> held() const { return {}; }
};

// A volume in memory: info.dims samples of info.type, x fastest, in the machine's byte order. The samples are not
// copied.
// @pre The samples outlive the source and stay as they are meanwhile.
// @throws std::invalid_argument when there are more samples or fewer, or when they are not aligned for their type
std::unique_ptr<SliceSource> volume_in_memory(const VolumeInfo& info, std::span<const std::byte> samples);

// Layout of a headerless file.
struct RawLayout {
  std::array<std::int64_t, 3> dims{0, 0, 0};
  SampleType type = SampleType::kUint8;
  bool big_endian = false;
  std::int64_t skip_bytes = 0;
};

// Parses "WxHxD:type[:big][:skip=N]", e.g. "512x512x300:int16:big:skip=1024".
// @throws std::invalid_argument naming the part that is wrong
RawLayout parse_raw_layout(std::string_view text);

// Reads a name such as "foot_256x256x256_uint8.raw" as a layout. Nothing if the name does not tell one.
std::optional<RawLayout> raw_layout_from_name(std::string_view path);

// The treatment of slices that are not evenly spaced (DICOM, rectilinear grids of VTK):
//   refuse    BadInput, which names the distances
//   resample  slices at an even distance, linear between the two nearest ones, on the way; a note says so
//   mean      slices as they are, at their mean distance: not where they were
enum class UnevenSlices : std::uint8_t { kRefuse, kResample, kMean };

// The axis of a stack or array that holds its slices. Some programs write slices as channels or as times.
enum class SliceAxis : std::uint8_t { kSlices, kChannels, kTimes };

struct OpenOptions {
  std::optional<RawLayout> raw;                  // read the file as headerless data of this layout
  std::optional<std::array<double, 3>> spacing;  // overrides the file's
  std::optional<std::array<double, 3>> origin;   // overrides the file's
  std::string unit;                              // of spacing and origin, in any spelling; overrides the file's
  std::string series;                            // UID of a DICOM series, where there are several; "none": without UID
  std::string dataset;                  // path or name of an array in the file or folder (HDF5, Zarr, N5, VTK, NPZ)
  std::optional<std::int64_t> level;    // 0: full size; of an image kept at several (OME-Zarr, N5, Imaris)
  std::optional<std::int64_t> channel;  // index along the axis of channels; none: the first
  std::optional<std::int64_t> time;     // index along the axis of time; none: the first
  SliceAxis slices_from = SliceAxis::kSlices;  // where not kSlices, the axis of slices must have one sample
  UnevenSlices uneven_slices = UnevenSlices::kResample;
  bool external = true;  // whether a header may name other files; false, for files from strangers: BadInput
};

// Opens a volume. The format is told by its content, then by its name: NRRD, MetaImage, NIfTI, Analyze, MGH, MRC, NPY,
// NPZ, PVM, TIFF, VTK, HDF5, raw and others, in gzip too, or out of a pipe. A folder of Zarr, OME-Zarr or N5 is an
// array of chunks. Any other folder, or a pattern such as "slices/*.tif", is a series of one file per slice: TIFF, PNG
// or, with options.raw, samples alone, in the order of the numbers in their names; DICOM by position. A DICOM file
// stands for the series it belongs to, and a folder of DICOM for the folders below it too. docs/formats.md says what is
// read of each format. Only headers are read here, and their claims are compared with the sizes of files. Of a DICOM
// segmentation that does not say whether segments overlap, frames are read, too.
// @throws BadInput when there is no file, no slice, no known format or none of this build, when the header is wrong,
//   and for options that the format has no place for; std::invalid_argument for a unit that is not known; CannotWrite
//   when there is no room for a pipe's content
std::unique_ptr<SliceSource> open_volume(const std::string& path, const OpenOptions& options = {});

// A box of samples: [first, end) along each axis.
struct Region {
  std::array<std::int64_t, 3> first{0, 0, 0};
  std::array<std::int64_t, 3> end{0, 0, 0};
};

// A part of a volume, at its place in the whole.
// @throws std::invalid_argument for a region that is empty or reaches outside
// @cost Reads rows of the whole, or whole slices where the source has no rows; holds about a megabyte, or a slice.
std::unique_ptr<SliceSource> crop_volume(std::unique_ptr<SliceSource> volume, const Region& region);

// A smaller volume: every sample is the mean of a block of step x step x step samples (fewer at the upper ends), and
// lies in the middle of the block. NaN does not count; a block of nothing else is NaN. Means of 8- and 16-bit integers
// and of float32 are float32, others float64: they are not rounded. For values: thin_label_map is for labels.
// @throws std::invalid_argument for a step below 1
// @cost Holds one slice of sums, two of float64 samples, and one slice of the volume.
std::unique_ptr<SliceSource> downsample_volume(std::unique_ptr<SliceSource> volume, std::int64_t step);

// A smaller label map: every sample is the most frequent one of a block, of several the first in the block. Blocks lie
// as those of downsample_volume.
// @throws std::invalid_argument for a step below 1
// @cost Holds `step` slices of the map.
std::unique_ptr<SliceSource> thin_label_map(std::unique_ptr<SliceSource> map, std::int64_t step);

inline constexpr int kUsualSmoothing = 4;  // passes; docs/labels.md has the measurements
inline constexpr int kMostSmoothing = 64;

struct SmoothOptions {
  double iso = 0.5;          // a value: slope and intercept of the volume are accounted for
  bool inside_above = true;  // inside is value >= iso; else value <= iso. NaN is outside
  int passes = kUsualSmoothing;
};

// A mask without its staircase: a float32 volume, above 0 inside and below 0 outside. Its surface at iso 0 has the
// topology of the mask's surface and crosses the same edges of the lattice, each at another place. So no vertex moves
// by more than half the distance between two samples, and within that bound the surface becomes smooth (after Whitaker,
// "Reducing aliasing artifacts in iso-surfaces of binary volumes", 2000).
//
// In each pass the field f, +1 and -1 at first, becomes 2 B f - B B f, where B takes means of 3 x 3 x 3 samples with
// the weights 1-2-1 along each axis; it is then clamped to its side, 1/256 or more from 0. Taking a second blur back
// keeps round and thin objects from shrinking (after Taubin, "A signal processing approach to fair surface design",
// 1995). Samples beyond the border are as those at the border. The spacing is not used. threads: 0 for one per
// processor.
// @throws std::invalid_argument for an iso that is not finite, and for passes outside 1 to kMostSmoothing
// @cost Memory: for each sample of a slice 24 bytes per pass and 4 more, but only in rows near the surface, and one
//   slice of the volume. Reads ahead by 2 slices per pass.
// @determinism The same samples for any order of reads and any number of threads.
std::unique_ptr<SliceSource> smooth_mask(std::unique_ptr<SliceSource> volume, const SmoothOptions& options = {},
                                         int threads = 0);

// A label map is a volume whose values are whole numbers: integers, also with a slope and an intercept that are whole
// numbers, or floats up to 2^53. All functions that read one throw BadInput where it has another scaling, and when they
// find a value that is not a whole number: the message names it with its place.

// One label of a label map as a mask: uint8, 1 where the value is the label and 0 elsewhere, to be meshed at iso 0.5.
// @throws BadInput for a volume that is no label map, also from read()
std::unique_ptr<SliceSource> label_volume(std::unique_ptr<SliceSource> volume, Label label);

// The extent of a label, after a pass over the volume.
struct LabelExtent {
  Label label;
  std::uint64_t samples = 0;
  Region box;              // the smallest with all its samples; empty where there are none
  std::uint64_t runs = 0;  // of samples that follow each other along i
};

inline constexpr std::size_t kMostLabels = 4096;                   // in a file each
inline constexpr std::size_t kMostObjects = std::size_t{1} << 24;  // in one folder: see open_mesh_objects

// Finds labels in a label map: the `wanted` ones in their order, also those that do not occur. Where none are named,
// all labels that occur, ascending, but 0, which is background. Reads the volume once.
// @throws BadInput when all labels are more than `most`, and for a volume that is no label map; Interrupted when
//   `stop` is set
// @cost Memory: some 200 bytes for each label.
std::vector<LabelExtent> find_labels(SliceSource& volume, std::span<const Label> wanted = {},
                                     const std::atomic<bool>* stop = nullptr, std::size_t most = kMostLabels);

// Opens a volume once more, from its beginning.
using VolumeOpener = std::function<std::unique_ptr<SliceSource>()>;

// The same as find_labels, from boxes of `size` samples along each axis: the volume is opened for each. A run that goes
// on in the next box counts as two.
// @throws what find_labels and `open` throw
// @cost Memory: a slice of a box, and what the source holds for it. Chunks of Zarr and tiles are decoded once for each
//   box along x and y that they touch.
std::vector<LabelExtent> find_labels_in_blocks(const VolumeOpener& open, std::int64_t size,
                                               std::span<const Label> wanted = {},
                                               const std::atomic<bool>* stop = nullptr, std::size_t most = kMostLabels);

// The number of labels that are spread like the grey values of an image: thin, and hardly filling their box. A volume
// in which most labels are is no label map, as a rule; docs/labels.md has the measurements.
std::size_t count_scattered(std::span<const LabelExtent> labels);

// Whether labels look like those of a label map: they are few, or no more than half of them are scattered.
bool look_like_labels(std::span<const LabelExtent> labels);

// Whether a volume looks like a mask or label map: whole numbers from 0 on that look like labels, in its middle slices.
// @throws what the source throws; Interrupted when `stop` is set
// @cost Reads at most 64 slices.
bool looks_like_label_map(std::unique_ptr<SliceSource> volume, const std::atomic<bool>* stop = nullptr);

}  // namespace isoweave
#pragma GCC visibility pop
