#include "volume/formats/dicom/dicom_segmentation.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "parallel/size.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/dicom/dicom_axes.hpp"
#include "volume/formats/dicom/dicom_places.hpp"
#include "volume/formats/dicom/frame_planes.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

using Samples = std::vector<std::byte>;

enum class Kind { kBinary, kFractional, kLabelMap };

Kind kind_of(const DicomSlice& slice) {
  const std::string& type = slice.segmentation->type();
  if (type == "BINARY") return Kind::kBinary;
  if (type == "FRACTIONAL") return Kind::kFractional;
  if (type == "LABELMAP") return Kind::kLabelMap;
  bad_input(slice.path, "BINARY, FRACTIONAL or LABELMAP as Segmentation Type", type.empty() ? "none" : in_quotes(type));
}

// A segmentation: its frames, the planes that they lie in, and its segments.
class Segmentation {
 public:
  Segmentation(const std::vector<DicomSlice>& frames, const std::string& path, const OpenOptions& options)
      : path_(path), kind_(kind_of(frames.front())), series_(place_series(frames)) {
    refuse_several_files();
    planes_ = frame_planes(series_, path, options);
    if (kind_ != Kind::kLabelMap) list_segments();
    group_frames();
  }

  const PlacedSeries& series() const { return series_; }
  const FramePlanes& planes() const { return planes_; }
  Kind kind() const { return kind_; }
  const DicomSegments& segments() const { return *first().segmentation; }
  const DicomSlice& first() const { return series_.slices.front().slice; }

  // The segments that lie in layers of their own; none where all are in one.
  std::vector<std::uint32_t> layers() const {
    const bool fractions = kind_ == Kind::kFractional && numbers_.size() > 1;
    return fractions || (kind_ == Kind::kBinary && overlaps()) ? numbers_ : std::vector<std::uint32_t>();
  }

  SampleType type() const {
    if (kind_ != Kind::kBinary) return series_.facts.type;
    constexpr std::uint32_t kMostOfByte = 255;
    return numbers_.back() <= kMostOfByte ? SampleType::kUint8 : SampleType::kUint16;
  }

  // The samples of a plane, of all segments or of one; where there is no frame, 0.
  Samples plane(std::int64_t number, std::optional<std::uint32_t> segment, SampleType type) const {
    Samples samples(samples_of_frame() * sample_bytes(type));
    if (number < 0 || number >= planes_.count) return samples;
    for (const std::size_t n : frames_in_[static_cast<std::size_t>(number)]) {
      const DicomSlice& frame = series_.slices[n].slice;
      if (segment && frame.segment != *segment) continue;
      if (kind_ != Kind::kBinary) return decoded(frame);
      visit_sample_type(type, [&]<class T>() { mark<T>(frame, samples); });
    }
    return samples;
  }

 private:
  std::size_t samples_of_frame() const { return to_size(series_.facts.columns * series_.facts.rows, 1); }

  Samples decoded(const DicomSlice& frame) const {
    return decode_dicom(frame, series_.facts.type, samples_of_frame() * sample_bytes(series_.facts.type));
  }

  // Writes the number of a frame's segment where the frame is not 0.
  template <class T>
  void mark(const DicomSlice& frame, Samples& samples) const {
    const Samples within = decoded(frame);
    auto* const out = reinterpret_cast<T*>(samples.data());
    const auto label = static_cast<T>(frame.segment);
    bool shared = false;
    for (std::size_t n = 0; n < within.size(); ++n) {
      if (within[n] == std::byte{0}) continue;
      shared = shared || out[n] != T{0};
      out[n] = label;
    }
    if (shared) bad_input(frame.path, "segments that do not overlap (Segments Overlap: NO)", "two that do");
  }

  void refuse_several_files() const {
    for (const PlacedSlice& frame : series_.slices) {
      if (frame.slice.file == first().file) continue;
      bad_input(path_, "one segmentation, or one file of them",
                in_quotes(first().file) + ", " + in_quotes(frame.slice.file));
    }
  }

  // Lists the numbers of all segments, ascending, with those that have no frame.
  void list_segments() {
    for (const LabelName& segment : segments().names()) {
      if (segment.label != Label(0)) numbers_.push_back(static_cast<std::uint32_t>(segment.label.bits()));
    }
    for (const PlacedSlice& frame : series_.slices) numbers_.push_back(frame.slice.segment);
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    if (numbers_.front() == 0)
      bad_input(path_, "frames of segments from 1 on (Referenced Segment Number)", "0 or none");
    if (kind_ == Kind::kBinary && series_.facts.type != SampleType::kUint8) {
      bad_input(path_, "samples of 1 bit or 8 in a binary segmentation",
                std::string(sample_type_name(series_.facts.type)));
    }
  }

  // Groups the frames by planes. Of a segment there is one in a plane at most.
  void group_frames() {
    frames_in_.resize(to_size(planes_.count, 1));
    std::set<std::pair<std::int64_t, std::uint32_t>> seen;
    for (std::size_t n = 0; n < series_.slices.size(); ++n) {
      const DicomSlice& frame = series_.slices[n].slice;
      if (!seen.insert({planes_.of_frame[n], frame.segment}).second) {
        bad_input(frame.path, "one frame of a segment in a place",
                  "another of segment " + std::to_string(frame.segment));
      }
      frames_in_[static_cast<std::size_t>(planes_.of_frame[n])].push_back(n);
    }
  }

  // Whether a sample is in two segments. The file may say it; else frames in one plane are compared.
  bool overlaps() const {
    const std::string& said = segments().said_to_overlap();
    if (said == "YES" || said == "NO") return said == "YES" && numbers_.size() > 1;
    return std::any_of(frames_in_.begin(), frames_in_.end(), [&](const auto& frames) { return overlap(frames); });
  }

  bool overlap(const std::vector<std::size_t>& frames) const {
    if (frames.size() < 2) return false;
    Samples all(samples_of_frame());
    for (const std::size_t n : frames) {
      const Samples one = decoded(series_.slices[n].slice);
      for (std::size_t m = 0; m < all.size(); ++m) {
        if (one[m] != std::byte{0} && std::exchange(all[m], one[m]) != std::byte{0}) return true;
      }
    }
    return false;
  }

  std::string path_;
  Kind kind_;
  PlacedSeries series_;
  FramePlanes planes_;
  std::vector<std::uint32_t> numbers_;               // of segments, ascending; none in a label map
  std::vector<std::vector<std::size_t>> frames_in_;  // each plane, by their places in the series
};

// The names of segments, each with its layer. Segments in layers of their own are listed without a name, too, as a
// layer is found by them.
std::vector<LabelName> labels_of(const DicomSegments& segments, const std::vector<std::uint32_t>& layers) {
  std::vector<LabelName> labels;
  for (const LabelName& label : segments.names()) {
    if (label.label != Label(0)) labels.push_back(label);
  }
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const auto has_number = [&](const LabelName& label) { return label.label == Label(layers[n]); };
    auto label = std::find_if(labels.begin(), labels.end(), has_number);
    if (label == labels.end()) label = labels.insert(labels.end(), {Label(layers[n]), {}, {}, 0});
    label->layer = static_cast<std::int64_t>(n);
  }
  return labels;
}

// Chooses a layer, and sets what that says of the volume.
std::int64_t choose_layer(VolumeInfo& info, std::size_t layers, const OpenOptions& options) {
  refuse_slices_from(options, info.path);
  const auto channels = static_cast<std::int64_t>(std::max<std::size_t>(layers, 1));
  const AxisChoice choice = choose_axes(
      {{channels, "channel"}, {info.dims[2], "z"}, {info.dims[1], "y"}, {info.dims[0], "x"}}, options, info.path);
  info.part = choice.part;
  info.notes.insert(info.notes.end(), choice.notes.begin(), choice.notes.end());
  return choice.at[0];
}

// Adds an empty plane below all frames and one above: those that writers left out are empty, and else the surface
// would end in the planes of the outermost frames.
void add_empty_planes(VolumeInfo& info) {
  Geometry& geometry = info.geometry;
  for (std::size_t n = 0; n < 3; ++n) geometry.origin[n] -= geometry.direction[3 * n + 2] * geometry.spacing[2];
  info.dims[2] += 2;
  info.remarks.emplace_back("an empty slice is added on both sides: segmentations leave empty frames out");
}

// Samples of a fraction become parts of 1.
void set_fractions(VolumeInfo& info, const Segmentation& segmentation) {
  const std::uint32_t most = segmentation.segments().most_fraction();
  if (most == 0) bad_input(info.path, "a Maximum Fractional Value above 0", "0 or none");
  info.slope = 1.0 / most;
  info.remarks.emplace_back("samples are the fractions of a segment, from 0 to 1: --iso 0.5 is its surface");
}

std::unique_ptr<ByteStream> planes_of(const std::shared_ptr<const Segmentation>& segmentation, const VolumeInfo& info,
                                      std::optional<std::uint32_t> segment) {
  const auto open = [segmentation, segment, type = info.type](std::int64_t n) {
    return std::make_unique<DecodedStream>([=] { return segmentation->plane(n - 1, segment, type); });
  };
  const auto name = [path = info.path](std::int64_t) { return path; };
  return std::make_unique<FileSequence>(info.dims[2], info.slice_bytes(), open, name);
}

}  // namespace

OpenedVolume open_dicom_segmentation(const std::vector<DicomSlice>& frames, const std::string& path,
                                     const OpenOptions& options) {
  const auto segmentation = std::make_shared<const Segmentation>(frames, path, options);
  const PlacedSeries& series = segmentation->series();
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = path;
  info.format = "dicom-seg";
  info.type = segmentation->type();
  info.dims = {series.facts.columns, series.facts.rows, segmentation->planes().count};
  info.notes = series.notes;
  info.notes.insert(info.notes.end(), segmentation->planes().notes.begin(), segmentation->planes().notes.end());
  info.data_files = {segmentation->first().file};
  check_sizes(series.slices, info.slice_bytes());
  set_dicom_axes(info, series, info.dims[2]);
  add_empty_planes(info);
  const std::vector<std::uint32_t> layers = segmentation->layers();
  const auto layer = static_cast<std::size_t>(choose_layer(info, layers.size(), options));
  info.labels = labels_of(segmentation->segments(), layers);
  checked_volume_bytes(info);
  if (segmentation->kind() == Kind::kFractional) set_fractions(info, *segmentation);
  volume.held_bytes = 3 * info.slice_bytes();  // a plane, a frame as bytes and as it is stored
  volume.samples = planes_of(segmentation, info, layers.empty() ? std::nullopt : std::optional(layers[layer]));
  return volume;
}

}  // namespace isoweave
