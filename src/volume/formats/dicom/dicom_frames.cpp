#include "volume/formats/dicom/dicom_frames.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kMostFrames = 1 << 17;

void override_with(std::string& text, const std::string& other) {
  if (!other.empty()) text = other;
}

// The name of an element that stands for Pixel Data and is not read; empty for others.
std::string_view unread_samples(std::uint32_t tag) {
  if (tag == 0x00287fe0) return "Pixel Data Provider URL";
  if (tag == 0x7fe00008) return "Float Pixel Data";
  if (tag == 0x7fe00009) return "Double Float Pixel Data";
  return {};
}

}  // namespace

void DicomFrames::take(const DicomElementWalk& walk, const DicomElement& element) {
  constexpr std::uint32_t kSharedGroups = 0x52009229;
  constexpr std::uint32_t kFrameGroups = 0x52009230;
  // A group's sequence, its item, the macro's sequence, its item.
  constexpr std::size_t kDepth = 4;
  stack_.take(walk, element);
  segments_.take(walk, element);
  if (walk.depth() == 0) {
    if (const std::string_view name = unread_samples(element.tag); !name.empty()) unread_ = name;
    group_ = element.tag == kSharedGroups ? Group::kShared : element.tag == kFrameGroups ? Group::kFrame : Group::kNone;
  } else if (group_ == Group::kFrame && walk.depth() == 1 && element.tag == DicomElement::kItem) {
    if (frames_.size() == kMostFrames) {
      bad_input(file_.path(), "no more than " + std::to_string(kMostFrames) + " frames", "more");
    }
    frames_.emplace_back();
  } else if (group_ != Group::kNone && walk.depth() == kDepth) {
    take_place(walk, element);
  }
}

void DicomFrames::take_place(const DicomElementWalk& walk, const DicomElement& element) {
  struct Known {
    std::uint32_t tag;
    std::string Place::*field;
  };
  static constexpr std::array<Known, 8> kKnown{{{0x00089007, &Place::image_type},
                                                {0x00180050, &Place::thickness},
                                                {0x00180088, &Place::slice_spacing},
                                                {0x00200032, &Place::position},
                                                {0x00200037, &Place::orientation},
                                                {0x00280030, &Place::pixel_spacing},
                                                {0x00281052, &Place::intercept},
                                                {0x00281053, &Place::slope}}};
  constexpr std::uint32_t kSegment = 0x0062000b;
  if (group_ == Group::kFrame && frames_.empty()) return;
  Place& place = group_ == Group::kShared ? shared_ : frames_.back();
  if (element.tag == kSegment && element.length >= 2) place.segment = walk.number(element.value, 2);
  for (const Known& known : kKnown) {
    if (known.tag == element.tag) place.*known.field = walk.text(element);
  }
  take_moment(place.moments, walk, element);
}

void DicomFrames::set_samples(bool packed, DicomFragments fragments, DicomRange plain) {
  has_samples_ = true;
  packed_ = packed;
  fragments_ = std::move(fragments);
  plain_ = plain;
}

std::size_t DicomFrames::count_of(const DicomSlice& common) const {
  const auto said = common.frames.empty() ? 1 : parse_integer(common.frames).value_or(0);
  if (said < 1) bad_input(common.path, "a number of frames", in_quotes(common.frames));
  if (static_cast<std::uint64_t>(said) > kMostFrames) {
    bad_input(common.path, "no more than " + std::to_string(kMostFrames) + " frames", std::to_string(said));
  }
  if (!frames_.empty() && frames_.size() != static_cast<std::uint64_t>(said)) {
    bad_input(common.path, "groups for each of " + std::to_string(said) + " frames", std::to_string(frames_.size()));
  }
  return static_cast<std::size_t>(said);
}

DicomSlice DicomFrames::slice(const DicomSlice& common, std::size_t frame) const {
  DicomSlice slice = common;
  for (const Place* const place : {&shared_, frames_.empty() ? &shared_ : &frames_[frame]}) {
    override_with(slice.position, place->position);
    override_with(slice.orientation, place->orientation);
    override_with(slice.pixel_spacing, place->pixel_spacing);
    override_with(slice.slice_spacing, place->slice_spacing);
    override_with(slice.thickness, place->thickness);
    override_with(slice.slope, place->slope);
    override_with(slice.intercept, place->intercept);
    override_with(slice.image_type, place->image_type);
    for (std::size_t n = 0; n < slice.moments.size(); ++n) override_with(slice.moments[n], place->moments[n]);
    if (place->segment != 0) slice.segment = place->segment;
  }
  return slice;
}

std::vector<DicomSlice> DicomFrames::slices(const DicomSlice& common) const {
  if (!has_samples_) {
    bad_input(common.path, "samples of whole numbers (Pixel Data)",
              unread_.empty() ? "none" : std::string(unread_) + ", which is not read");
  }
  const std::size_t count = count_of(common);
  std::vector<std::vector<DicomRange>> samples = samples_of(common, count);
  std::vector<DicomSlice> slices;
  for (std::size_t frame = 0; frame < count; ++frame) {
    slices.push_back(slice(common, frame));
    if (count > 1) slices.back().path += " (frame " + std::to_string(frame + 1) + ")";
    slices.back().frame = frame;
    slices.back().packed = packed_;
    if (!packed_) slices.back().first_bit = static_cast<int>(frame * common.plain_bits() % 8);
    slices.back().pixels = std::move(samples[frame]);
  }
  if (is_segmentation_class(common.media)) {
    add_segments(slices);
  } else if (frames_.empty() && count > 1) {
    stack_.place(slices);
  }
  return slices;
}

// Says of each slice that it is of a segmentation, whose frames lie where their groups say and nowhere else.
void DicomFrames::add_segments(std::vector<DicomSlice>& slices) const {
  const auto segments = std::make_shared<const DicomSegments>(segments_);
  for (DicomSlice& slice : slices) slice.segmentation = segments;
}

std::vector<std::vector<DicomRange>> DicomFrames::samples_of(const DicomSlice& common, std::size_t count) const {
  if (count == 1) return {packed_ ? fragments_.list : std::vector<DicomRange>{plain_}};
  std::vector<std::vector<DicomRange>> samples;
  if (packed_ && fragments_.list.size() != count) return fragments_by_table(common.path, count);
  const std::uint64_t bits = common.plain_bits();
  if (bits == 0) bad_input(common.path, "samples of 1, 8, 16 or 32 bits", std::to_string(common.bits));
  if (!packed_ && bits > 8 * plain_.second / count) {
    bad_input(common.path, std::to_string((bits * count + 7) / 8) + " bytes of samples", std::to_string(plain_.second));
  }
  for (std::size_t frame = 0; frame < count; ++frame) {
    const std::uint64_t begin = frame * bits / 8;
    const std::uint64_t end = (frame * bits + bits + 7) / 8;
    samples.push_back({packed_ ? fragments_.list[frame] : DicomRange{plain_.first + begin, end - begin}});
  }
  return samples;
}

std::uint32_t DicomFrames::table_entry(std::size_t n) const {
  DicomElementWalk walk(file_, fragments_.table.first);
  return walk.number(fragments_.table.first + 4 * n, 4);
}

// The table has the first fragment of each frame, counted in bytes from the first fragment of all.
std::vector<std::vector<DicomRange>> DicomFrames::fragments_by_table(const std::string& path, std::size_t count) const {
  if (fragments_.list.empty() || fragments_.table.second != 4 * std::uint64_t{count}) {
    bad_input(path, "one fragment of packed samples for each of " + std::to_string(count) + " frames, or their offsets",
              std::to_string(fragments_.list.size()) + " fragments");
  }
  const std::uint64_t begin = fragments_.list.front().first;
  std::vector<std::vector<DicomRange>> samples(count);
  std::size_t next = 0;
  for (std::size_t frame = 0; frame < count; ++frame) {
    const std::uint64_t end = frame + 1 < count ? begin + table_entry(frame + 1) : ~std::uint64_t{0};
    while (next < fragments_.list.size() && fragments_.list[next].first < end) {
      samples[frame].push_back(fragments_.list[next++]);
    }
    if (samples[frame].empty()) {
      bad_input(path, "fragments of packed samples for frame " + std::to_string(frame + 1), "none");
    }
  }
  return samples;
}

}  // namespace isoweave
