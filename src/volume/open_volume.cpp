// Tells the format of a file by its content, then by its name, and hands it to the format's reader.
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include "isoweave/error.hpp"
#include "volume/dicom_file.hpp"
#include "volume/dicom_series.hpp"
#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"
#include "volume/slice_files.hpp"
#include "volume/slice_series.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kHeadBytes = 1024;

// What a file holds once inflated; empty when it is no gzip file, or a broken one.
std::string inflated_head(const FilePtr& file, std::string_view head) {
  if (!head.starts_with("\x1f\x8b")) return {};
  std::string text(kNiftiHeadBytes, '\0');
  InflateStream stream(std::make_unique<FileStream>(file, 0, file->size()), file->path());
  text.resize(stream.read(std::as_writable_bytes(std::span(text))));
  return text;
}

// The format that a name stands for, for the message when the content is not of it.
std::string_view format_of_name(std::string_view name) {
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr")) return "the magic NRRD0001 to NRRD0005";
  if (name.ends_with(".nii") || name.ends_with(".nii.gz") || name.ends_with(".hdr")) return "a NIfTI header";
  if (name.ends_with(".pvm")) return "the magic PVM, PVM2, PVM3, DDS v3d or DDS v3e";
  if (name.ends_with(".raw")) return "a layout in the name, as in name_256x256x128_uint8.raw";
  if (name.ends_with(".tif") || name.ends_with(".tiff")) return "the magic of TIFF or BigTIFF";
  if (name.ends_with(".png")) return "the magic of PNG";
  if (name.ends_with(".vti")) return "<VTKFile type=\"ImageData\">";
  if (name.ends_with(".vtk")) return "the line '# vtk DataFile Version'";
  if (name.ends_with(".dcm")) return "DICM behind a preamble of 128 bytes, or the elements of a DICOM data set";
  if (name.ends_with(".h5") || name.ends_with(".hdf5")) return "the magic of HDF5";
  return "NRRD, MetaImage, NIfTI, PVM, TIFF, PNG, DICOM, VTK, HDF5, or raw with a layout";
}

// "scan.hdr" for "scan.img": the samples of a NIfTI pair do not say what they are.
std::string header_of_image(const std::string& path) {
  constexpr std::string_view kImage = ".img";
  return path.ends_with(kImage) ? path.substr(0, path.size() - kImage.size()) + ".hdr" : std::string();
}

OpenedVolume open_by_name(const FilePtr& file, const OpenOptions& options) {
  const std::string& path = file->path();
  if (const std::optional<RawLayout> layout = raw_layout_from_name(path)) return open_raw(file, *layout);
  const std::string name = lower_case(path);
  if (name.ends_with(".mha") || name.ends_with(".mhd")) return open_metaimage(file, options);
  const std::string header = header_of_image(path);
  if (!header.empty()) {
    OpenedVolume volume = open_nifti(open_file(header), false, options);
    volume.info.path = path;
    return volume;
  }
  bad_input(path, format_of_name(name), "other content");
}

OpenedVolume open_by_content(const FilePtr& file, const OpenOptions& options) {
  const std::string head = file->head(kHeadBytes);
  if (head.starts_with("NRRD")) return open_nrrd(file, options);
  if (is_tiff(head)) return open_tiff(file, false, options);
  if (is_png(head)) return open_png(file);
  if (is_vti(head)) return open_vti(file, options);
  if (is_vtk_legacy(head)) return open_vtk_legacy(file, options);
  if (is_pvm(head)) return open_pvm(file);
  if (is_metaimage(head)) return open_metaimage(file, options);
  if (is_nifti(head)) return open_nifti(file, false, options);
  if (is_nifti(inflated_head(file, head))) return open_nifti(file, true, options);
  if (is_hdf5(*file)) return open_hdf5(file, options);
  return open_by_name(file, options);
}

void refuse_series(const std::string& path, const std::string& series) {
  if (!series.empty()) bad_input(path, "the DICOM series " + quoted(series), "no DICOM");
}

bool is_one_of(std::string_view format, std::initializer_list<std::string_view> formats) {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

// Options that choose among what other formats do not have. Readers that have it refuse what is not in the file.
void refuse_array_options(const VolumeInfo& info, const OpenOptions& options) {
  const bool array = is_one_of(info.format, {"hdf5", "zarr", "n5"});
  // VTK's files have arrays with names, and no levels.
  const bool named = array || is_one_of(info.format, {"vti", "vtk"});
  if ((!named && !options.dataset.empty()) || (!array && options.level)) {
    bad_input(info.path, "HDF5, Zarr or N5 for --dataset and --level", info.format);
  }
  const bool axes = array || is_one_of(info.format, {"tiff", "nifti", "nrrd", "metaimage"});
  if (!axes && (options.channel || options.time || options.slices_from != SliceAxis::kSlices)) {
    bad_input(info.path, "TIFF, NIfTI, NRRD, MetaImage, HDF5, Zarr or N5 for --channel, --time and --slices-from",
              info.format);
  }
}

OpenedVolume open_folder(const std::string& path, const OpenOptions& options) {
  if (is_folder(path) && is_array_folder(path)) {
    refuse_series(path, options.series);
    return open_zarr(path, options);
  }
  const SliceFiles slices = find_slices(path);
  if (slices.kind == SliceKind::kDicom) return open_dicom_series(slices, options);
  refuse_series(path, options.series);
  return open_slice_series(slices, options);
}

OpenedVolume open_dicom(const std::string& path, const OpenOptions& options) {
  if (!is_dicomdir(path)) return open_dicom_file(path, options);
  return open_dicom_series(slices_of_export(path), options);
}

OpenedVolume open_any(const std::string& path, const OpenOptions& options) {
  if (options.raw) return open_raw(open_file(path), *options.raw);
  if (is_folder(path) || is_pattern(path)) return open_folder(path, options);
  const FilePtr file = open_file(path);
  if (is_dicom(file->head(kDicomHeadBytes))) return open_dicom(path, options);
  refuse_series(path, options.series);
  return open_by_content(file, options);
}

}  // namespace

std::unique_ptr<SliceSource> open_volume(const std::string& path, const OpenOptions& options) {
  OpenedVolume volume = open_any(path, options);
  refuse_array_options(volume.info, options);
  if (!volume.unit_conflict.empty() && !options.spacing) {
    bad_input(volume.info.path, "units of length that can be made one, or --spacing", volume.unit_conflict);
  }
  apply_overrides(volume.info.geometry, options);
  return std::make_unique<StreamSource>(std::move(volume));
}

}  // namespace isoweave
