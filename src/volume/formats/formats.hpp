// One reader per format: reads the header, checks its claims, and gives the stream of samples.
// All throw BadInput. Geometry overrides are applied by open_volume; `options` are for what is chosen of a file.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "files/input_file.hpp"
#include "isoweave/volume.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

OpenedVolume open_raw(const FilePtr& file, const RawLayout& layout);
// Whether a file has just the size of the layout.
bool fits_raw(const InputFile& file, const RawLayout& layout);
// A file of samples without a header for each slice, by the layout `options.raw`: those that a pattern names, or that
// are in a folder.
OpenedVolume open_raw_slices(const std::string& path, const OpenOptions& options);

// Whether `head`, the first bytes of a file, are a NIfTI header.
bool is_nifti(std::string_view head);
// Throws BadInput where a file that is named as a NIfTI file with its samples begins as one, and its magic is another:
// damaged, or that of a header beside its samples.
void refuse_other_magic(const std::string& path, std::string_view head);
OpenedVolume open_nifti(const FilePtr& file, const OpenOptions& options);
// The file of samples that belongs to a header file: "scan.img" or "scan.img.gz" for "scan.hdr".
FilePtr image_of_header(const std::string& header_path);
// Bytes of a file that is_nifti needs.
inline constexpr std::size_t kNiftiHeadBytes = 540;

// Needs as many bytes as is_nifti.
bool is_analyze(std::string_view head);
OpenedVolume open_analyze(const FilePtr& file, const OpenOptions& options);

bool is_mgh(std::string_view head);
OpenedVolume open_mgh(const FilePtr& file, const OpenOptions& options);

bool is_mrc(std::string_view head);
// Whether the numbers are those of a header, as in files from before there was a magic.
bool is_old_mrc(std::string_view head);
OpenedVolume open_mrc(const FilePtr& file, const OpenOptions& options);
// Bytes of a file that is_mrc and is_old_mrc need.
inline constexpr std::size_t kMrcHeadBytes = 1024;

bool is_npy(std::string_view head);
OpenedVolume open_npy(const FilePtr& file, const OpenOptions& options);

// Whether an archive is NPZ, by the first name in it, or by its own name.
bool is_npz(std::string_view head, std::string_view path);
// The dataset of the options is the name of an array.
OpenedVolume open_npz(const FilePtr& file, const OpenOptions& options);

bool is_amira(std::string_view head);
OpenedVolume open_amira(const FilePtr& file);

bool is_slc(std::string_view head);
OpenedVolume open_slc(const FilePtr& file);

bool is_fits(std::string_view head);
OpenedVolume open_fits(const FilePtr& file, const OpenOptions& options);

OpenedVolume open_nrrd(const FilePtr& file, const OpenOptions& options);

// Whether `head` begins as a MetaImage header does.
bool is_metaimage(std::string_view head);
OpenedVolume open_metaimage(const FilePtr& file, const OpenOptions& options);

bool is_pvm(std::string_view head);
OpenedVolume open_pvm(const FilePtr& file);

bool is_vti(std::string_view head);
// The dataset of the options is the name of an array.
OpenedVolume open_vti(const FilePtr& file, const OpenOptions& options);

bool is_vtk_legacy(std::string_view head);
OpenedVolume open_vtk_legacy(const FilePtr& file, const OpenOptions& options);

// The readers below stand on libraries that a build may lack; what tells their files does not.
bool is_tiff(std::string_view head);
// `one_of_series`: the file is one slice of a series, and may describe the whole of it.
OpenedVolume open_tiff(const FilePtr& file, bool one_of_series, const OpenOptions& options);

bool is_png(std::string_view head);
OpenedVolume open_png(const FilePtr& file);

// Whether a file is DICOM, by its magic or, where it has none, by its first elements.
bool is_dicom(std::string_view head);
bool has_dicom_magic(std::string_view head);
// Bytes of a file that is_dicom needs, and where the magic ends.
inline constexpr std::size_t kDicomHeadBytes = 1024;
inline constexpr std::size_t kDicomMagicEnd = 132;

// Whether a file is HDF5. The magic may lie behind a block of the user's, of 512 bytes or a larger power of 2.
bool is_hdf5(const InputFile& file);
OpenedVolume open_hdf5(const FilePtr& file, const OpenOptions& options);

// Whether a folder holds metadata of Zarr or N5.
bool is_array_folder(const std::string& folder);
OpenedVolume open_zarr(const std::string& path, const OpenOptions& options);

}  // namespace isoweave
