// One reader per format: reads the header, checks its claims, and gives the stream of samples.
// All throw BadInput. Geometry overrides are applied by open_volume; `options` are for what is chosen of a file.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "isoweave/volume.hpp"
#include "volume/input_file.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

using FilePtr = std::shared_ptr<const InputFile>;

OpenedVolume open_raw(const FilePtr& file, const RawLayout& layout);

// Whether `head`, the first bytes of a file (of its inflated data where `gzip`), are a NIfTI header.
bool is_nifti(std::string_view head);
// `gzip`: the header and the samples are in a gzip stream.
OpenedVolume open_nifti(const FilePtr& file, bool gzip, const OpenOptions& options);
// Bytes of a file that is_nifti needs.
inline constexpr std::size_t kNiftiHeadBytes = 540;

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

// Its magic may lie behind a block of the user's, of 512 bytes or a larger power of 2.
bool is_hdf5(const InputFile& file);
OpenedVolume open_hdf5(const FilePtr& file, const OpenOptions& options);

// Whether a folder holds metadata of Zarr or N5.
bool is_array_folder(const std::string& folder);
OpenedVolume open_zarr(const std::string& path, const OpenOptions& options);

}  // namespace isoweave
