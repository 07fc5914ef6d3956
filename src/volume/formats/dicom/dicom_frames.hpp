// The frames of a DICOM file: where each lies in space, by the functional groups of enhanced images or as one of a
// stack, and in the file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/formats/dicom/dicom_moments.hpp"
#include "volume/formats/dicom/dicom_segments.hpp"
#include "volume/formats/dicom/dicom_stack.hpp"

namespace isoweave {

class DicomFrames {
 public:
  explicit DicomFrames(DicomBytes& file) : file_(file) {}

  // Every element of the data set, in order.
  void take(const DicomElementWalk& walk, const DicomElement& element);

  // Sets the places of the samples: `plain`, or the fragments of packed ones.
  void set_samples(bool packed, DicomFragments fragments, DicomRange plain);

  // One slice for each frame, with what `common` says of all of them. Throws BadInput when there are no samples, when
  // groups or fragments do not go together with the number of frames, and for frames that are no slices.
  std::vector<DicomSlice> slices(const DicomSlice& common) const;

 private:
  // The place according to the groups; empty where they do not give it.
  struct Place {
    std::string position, orientation, pixel_spacing, slice_spacing, thickness, slope, intercept, image_type;
    DicomMoments moments;
    std::uint32_t segment = 0;  // of a segmentation
  };
  enum class Group { kNone, kShared, kFrame };

  void take_place(const DicomElementWalk& walk, const DicomElement& element);
  std::size_t count_of(const DicomSlice& common) const;
  DicomSlice slice(const DicomSlice& common, std::size_t frame) const;
  void add_segments(std::vector<DicomSlice>& slices) const;
  std::vector<std::vector<DicomRange>> samples_of(const DicomSlice& common, std::size_t count) const;
  std::vector<std::vector<DicomRange>> fragments_by_table(const std::string& path, std::size_t count) const;
  std::uint32_t table_entry(std::size_t n) const;

  DicomBytes& file_;
  DicomStack stack_;
  DicomSegments segments_;
  Group group_ = Group::kNone;  // that the last element lies in
  Place shared_;
  std::vector<Place> frames_;
  bool has_samples_ = false;
  std::string_view unread_;  // what the data set has in place of samples that are read
  bool packed_ = false;
  DicomFragments fragments_;
  DicomRange plain_;
};

}  // namespace isoweave
