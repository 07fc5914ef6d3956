#include "volume/formats/other/unread_formats.hpp"

#include <algorithm>
#include <array>

#include "files/header_text.hpp"
#include "volume/zip_file.hpp"

namespace isoweave {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kMesh = "isoweave simplify takes it";
constexpr std::string_view kSlices = "slices are read in PNG or TIFF";
constexpr std::string_view kConvert = "Fiji or bfconvert write it as OME-TIFF, which is read";
constexpr std::string_view kUnpack = "unpack it first";

struct Unread {
  std::size_t at;
  std::string_view magic;
  std::string_view what;
  std::string_view way;
};

constexpr auto kUnread = std::to_array<Unread>({
    {0, "CDF\x01"sv, "classic netCDF, as MINC 1 is",
     "nccopy -k nc4, and mincconvert -2 for MINC 1, write what is read"},
    {0, "CDF\x02"sv, "classic netCDF, as MINC 1 is",
     "nccopy -k nc4, and mincconvert -2 for MINC 1, write what is read"},
    {0, "CDF\x05"sv, "classic netCDF", "nccopy -k nc4 writes HDF5, which is read"},
    {0, " BDV\0\0\0\0"sv, "OpenVDB, a sparse grid", "write it as a dense one, in VTI or NPY"},
    {0, "# HyperMesh"sv, "HyperMesh", "write it as NRRD or raw"},
    {0, "\xff\xd8\xff"sv, "a JPEG image", kSlices},
    {0, "\0\0\0\x0cjP  "sv, "a JPEG 2000 image", kSlices},
    {0, "\xff\x4f\xff\x51"sv, "a JPEG 2000 image", kSlices},
    {0, "GIF8"sv, "a GIF image", kSlices},
    {0, "P2\n"sv, "a Netpbm image", kSlices},
    {0, "P5\n"sv, "a Netpbm image", kSlices},
    {0, "P6\n"sv, "a Netpbm image", kSlices},
    {0, "RIFF"sv, "a RIFF file, such as WebP or video", kSlices},
    {0, "v/1\x01"sv, "an OpenEXR image", kSlices},
    {0, "ZISRAWFILE"sv, "Zeiss CZI", kConvert},
    {0, "\x70\0\0\0"sv, "Leica LIF", kConvert},
    {0, "\xda\xce\xbe\x0a"sv, "Nikon ND2", kConvert},
    {0, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv, "an OLE file, as Olympus OIB and Zeiss ZVI are", kConvert},
    {0, "7z\xbc\xaf\x27\x1c"sv, "a 7z archive", kUnpack},
    {0, "Rar!"sv, "a RAR archive", kUnpack},
    {0, "\x1f\x8b"sv, "a file in gzip twice", kUnpack},
    {257, "ustar"sv, "a tar archive", kUnpack},
    {0,
     "\xfd"
     "7zXZ\0"sv,
     "a file packed by xz", "xz -dc FILE | isoweave ... - reads it"},
    {0, "BZh"sv, "a file packed by bzip2", "bzip2 -dc FILE | isoweave ... - reads it"},
    {0, "\x28\xb5\x2f\xfd"sv, "a file packed by zstd", "zstd -dc FILE | isoweave ... - reads it"},
    {0, "\x04\x22\x4d\x18"sv, "a file packed by lz4", "lz4 -dc FILE | isoweave ... - reads it"},
    {0, "\x1f\x9d"sv, "a file packed by compress", "gzip -dc FILE | isoweave ... - reads it"},
    {0, "# === DATA DESCRIPTION FILE"sv, "a Philips PAR header", "dcm2niix makes NIfTI of PAR and REC"},
    {0, "##TITLE="sv, "Bruker's parameters", "the samples are in 2dseq, which --raw reads"},
    {0, "\ntype  ="sv, "a header of AFNI", "3dAFNItoNIFTI makes NIfTI of HEAD and BRIK"},
    {0, "type  = "sv, "a header of AFNI", "3dAFNItoNIFTI makes NIfTI of HEAD and BRIK"},
    {0, "mrtrix image"sv, "MRtrix", "mrconvert writes NIfTI"},
    {0, "!INTERFILE"sv, "an Interfile header", "--raw reads the file of samples that it names"},
    {0, "ENVI"sv, "an ENVI header", "--raw reads the file of samples beside it"},
    {0, "MATRIX7"sv, "ECAT 7", "write it as NIfTI"},
    {0, "MATLAB 5.0"sv, "a MATLAB file of version 5", "save(..., '-v7.3') writes HDF5, which is read"},
    {0, "\x80\x02"sv, "a pickle of Python", "numpy.save writes NPY, which is read"},
    {0, "%PDF"sv, "a PDF document", ""},
    {0, "version https://git-lfs"sv, "a pointer of Git LFS", "git lfs pull fetches the file"},
    {0, "<!DOCTYPE html"sv, "a web page", "what was to be downloaded is not here"},
    {0, "<html"sv, "a web page", "what was to be downloaded is not here"},
    {0, "{\\rtf"sv, "a text document", ""},
    {0, "BM"sv, "a BMP image", kSlices},
    {0, "ply\n"sv, "a mesh in PLY", kMesh},
    {0, "ply\r"sv, "a mesh in PLY", kMesh},
    {0, "solid "sv, "a mesh in STL", kMesh},
    {0, "# HyperSurface"sv, "a surface of Amira", "write it as PLY or STL for isoweave simplify"},
    {0, "\xff\xff\xfe"sv, "a surface of FreeSurfer", "mris_convert writes it as STL for isoweave simplify"},
    {0, "glTF"sv, "a mesh in GLB", kMesh},
    {0, "OFF\n"sv, "a mesh in OFF", kMesh},
    {0, "OFF "sv, "a mesh in OFF", kMesh},
    {0, "ncaa\n"sv, "VFF",
     "--raw ...:big:skip=N reads the samples behind its header, by size= and bits=, from behind the form feed"},
});

std::string sentence(std::string_view what, std::string_view way) {
  return std::string(what) + (way.empty() ? "" : ": ") + std::string(way);
}

// The kind of a zip archive, by the name of the first file in it.
std::string what_zip(std::string_view head) {
  const std::string_view name = first_zip_name(head);
  if (name == "[Content_Types].xml" || name.starts_with("3D/")) return sentence("a zip archive, as 3MF is", kMesh);
  if (name.find(".z") != std::string_view::npos || name.find("zarr.json") != std::string_view::npos) {
    return "Zarr in a zip archive: unpacked, the folder is read";
  }
  return sentence("a zip archive", kUnpack);
}

bool is_text(std::string_view head) {
  return std::none_of(head.begin(), head.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r' && byte != '\f';
  });
}

// Meshes that have no magic.
bool is_mesh_name(std::string_view path) {
  static constexpr std::array<std::string_view, 8> kEndings{".stl", ".obj", ".ply", ".off",
                                                            ".vtp", ".glb", ".3mf", ".gltf"};
  const std::string name = lower_case(path);
  return std::any_of(kEndings.begin(), kEndings.end(), [&](std::string_view end) { return name.ends_with(end); });
}

}  // namespace

std::string what_else(std::string_view head, std::string_view path) {
  if (is_zip(head)) return what_zip(head);
  for (const Unread& one : kUnread) {
    const bool there = head.size() >= one.at && head.substr(one.at).starts_with(one.magic);
    if (there) return sentence(one.what, one.way);
  }
  if (is_mesh_name(path)) return sentence("a mesh by its name", kMesh);
  return is_text(head) ? "text" : "other content";
}

}  // namespace isoweave
