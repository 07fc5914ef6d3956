// Stands in for the readers whose libraries the build lacks: an error that says which option brings them in.
#include "volume/formats/chunked/chunk_codecs.hpp"
#include "volume/formats/chunked/open_array.hpp"
#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/vtk/vtk_streams.hpp"

namespace isoweave {
namespace {

[[noreturn, maybe_unused]] void not_built(const std::string& path, std::string_view format, std::string_view library,
                                          std::string_view option) {
  bad_input(
      path, "a format of this build",
      std::string(format) + ", which needs " + std::string(library) + " (CMake option " + std::string(option) + "=ON)");
}

}  // namespace

#ifndef ISOWEAVE_HAS_TIFF
OpenedVolume open_tiff(const FilePtr& file, bool, const OpenOptions&) {
  not_built(file->path(), "TIFF", "libtiff", "ISOWEAVE_TIFF");
}
#endif

#ifndef ISOWEAVE_HAS_PNG
OpenedVolume open_png(const FilePtr& file) { not_built(file->path(), "PNG", "libpng", "ISOWEAVE_PNG"); }
#endif

#ifndef ISOWEAVE_HAS_JPEGLS
std::vector<std::byte> unpack_jpegls(const DicomSlice& slice, std::span<const std::byte>, std::size_t) {
  not_built(slice.path, "DICOM with JPEG-LS samples", "CharLS", "ISOWEAVE_JPEGLS");
}
#endif

#ifndef ISOWEAVE_HAS_JPEG2000
std::vector<std::byte> unpack_jpeg2000(const DicomSlice& slice, std::span<const std::byte>, std::size_t) {
  not_built(slice.path, "DICOM with JPEG 2000 samples", "OpenJPEG", "ISOWEAVE_JPEG2000");
}
#endif

#ifndef ISOWEAVE_HAS_HDF5
OpenedVolume open_hdf5(const FilePtr& file, const OpenOptions&) {
  not_built(file->path(), "HDF5", "libhdf5", "ISOWEAVE_HDF5");
}
#endif

#ifndef ISOWEAVE_HAS_ZARR
OpenedVolume open_zarr(const std::string& path, const OpenOptions&) {
  not_built(path, "Zarr or N5", "nlohmann-json", "ISOWEAVE_ZARR");
}
OpenedVolume open_array(const StorePtr&, const std::string& folder, const OpenOptions&) {
  not_built(folder, "Zarr or N5", "nlohmann-json", "ISOWEAVE_ZARR");
}
#endif

#ifndef ISOWEAVE_HAS_ZSTD
std::vector<std::byte> decode_zstd(std::span<const std::byte>, std::size_t, const std::string& path) {
  not_built(path, "a chunk in zstd", "libzstd", "ISOWEAVE_ZSTD");
}
#endif

#ifndef ISOWEAVE_HAS_BLOSC
std::vector<std::byte> decode_blosc(std::span<const std::byte>, std::size_t, const std::string& path) {
  not_built(path, "a chunk in Blosc", "libblosc", "ISOWEAVE_BLOSC");
}
#endif

#ifndef ISOWEAVE_HAS_LZMA
std::unique_ptr<ByteStream> open_lzma_block(std::unique_ptr<ByteStream>, std::uint64_t, std::uint64_t,
                                            const std::string& path) {
  not_built(path, "VTK XML with LZMA blocks", "liblzma", "ISOWEAVE_LZMA");
}
#endif

#ifndef ISOWEAVE_HAS_LZ4
std::unique_ptr<ByteStream> open_lz4_block(std::unique_ptr<ByteStream>, std::uint64_t, std::uint64_t,
                                           const std::string& path) {
  not_built(path, "VTK XML with LZ4 blocks", "liblz4", "ISOWEAVE_LZ4");
}

std::vector<std::byte> decode_lz4(std::span<const std::byte>, std::size_t, const std::string& path) {
  not_built(path, "a chunk in LZ4", "liblz4", "ISOWEAVE_LZ4");
}

std::vector<std::byte> decode_lz4_frames(std::span<const std::byte>, std::size_t, const std::string& path) {
  not_built(path, "a chunk in LZ4", "liblz4", "ISOWEAVE_LZ4");
}
#endif

}  // namespace isoweave
