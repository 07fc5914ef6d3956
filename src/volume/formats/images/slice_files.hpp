// Volumes kept as one file per slice: the files of a folder, or those that a pattern such as 'scan/*.tif' names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

// Whether `a` comes before `b` when runs of digits count as numbers: "z9.tif" before "z10.tif".
bool natural_less(std::string_view a, std::string_view b);

bool is_folder(const std::string& path);

// Whether a path is to be read as a pattern: it holds one of * ? [ and no file has this very name.
bool is_pattern(const std::string& path);

// The regular files of a folder that are not hidden, or the files that a pattern names, in natural order. Throws
// BadInput when a folder cannot be listed, when a pattern names no file and, where links may lead nowhere else
// (OpenOptions::external), for a file behind a link out of the folder.
std::vector<std::string> files_of(const std::string& path, const OpenOptions& options);

// The kind of one file of a series, told by its first bytes.
enum class SliceKind { kOther, kTiff, kPng, kDicom };

struct SliceFiles {
  std::string path;  // the folder or the pattern, as given
  SliceKind kind = SliceKind::kOther;
  std::vector<std::string> files;
  // The files of the folder that are none of the slices: those that might have been some, and those that a folder of
  // slices usually has beside them.
  std::vector<std::string> notes{}, remarks{};
};

// The slices of a folder or pattern: files of one kind. A folder of DICOM, or without slices of its own, stands for the
// DICOM files of all folders below it as well. Other files of a folder are left out and noted, pictures among them
// where a DICOMDIR says that the folder is an export of DICOM; those that a pattern names must all be slices. Throws
// BadInput when there is none, when there are two kinds, or when the content of a file is not what its name says.
// Links out of the folder are refused where files_of refuses them.
SliceFiles find_slices(const std::string& path, const OpenOptions& options);

// Whether two paths name one file.
bool is_same_file(const std::string& a, const std::string& b);

// The slices of the folder that a DICOMDIR lies in, and of those below.
SliceFiles slices_of_export(const std::string& dicomdir, const OpenOptions& options);

// The DICOM files in the folder of a file, itself among them.
std::vector<std::string> dicom_files_beside(const std::string& path, const OpenOptions& options);

}  // namespace isoweave
