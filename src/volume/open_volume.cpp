// Tells the format of a file by its content, then by its name, and hands it to the format's reader.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include "files/external_files.hpp"
#include "files/header_text.hpp"
#include "files/part_file.hpp"
#include "files/quoted.hpp"
#include "files/remote_store.hpp"
#include "files/whole_input.hpp"
#include "isoweave/error.hpp"
#include "parallel/float_environment.hpp"
#include "system/file_facts.hpp"
#include "volume/axes.hpp"
#include "volume/formats/chunked/open_array.hpp"
#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/formats/dicom/dicom_series.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/images/slice_files.hpp"
#include "volume/formats/images/slice_series.hpp"
#include "volume/formats/other/unread_formats.hpp"
#include "volume/packed_file.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kHeadBytes = std::max(kWhatElseBytes, kMrcHeadBytes);

// Maps of electron microscopy, which had no magic before the year 2000.
bool is_mrc_name(std::string_view name) {
  static constexpr std::array<std::string_view, 8> kEndings{".mrc", ".mrcs", ".map", ".ccp4",
                                                            ".rec", ".st",   ".ali", ".preali"};
  return std::any_of(kEndings.begin(), kEndings.end(), [&](std::string_view end) { return name.ends_with(end); });
}

// The format that a name stands for. A message names it when the content is of another format.
std::string_view format_of_name(std::string_view name) {
  if (name.ends_with(".nrrd") || name.ends_with(".nhdr")) return "the magic NRRD0001 to NRRD0005";
  if (name.ends_with(".nii") || name.ends_with(".nii.gz") || name.ends_with(".hdr")) return "a NIfTI header";
  if (name.ends_with(".pvm")) return "the magic PVM, PVM2, PVM3, DDS v3d or DDS v3e";
  if (name.ends_with(".raw")) return "a layout in the name, as in name_256x256x128_uint8.raw";
  if (name.ends_with(".tif") || name.ends_with(".tiff")) return "the magic of TIFF or BigTIFF";
  if (name.ends_with(".png")) return "the magic of PNG";
  if (name.ends_with(".vtr")) return "<VTKFile type=\"RectilinearGrid\">";
  if (name.ends_with(".vti")) return "<VTKFile type=\"ImageData\">";
  if (name.ends_with(".vtk")) return "the line '# vtk DataFile Version'";
  if (name.ends_with(".dcm")) return "DICM behind a preamble of 128 bytes, or the elements of a DICOM data set";
  if (name.ends_with(".am")) return "the line '# AmiraMesh'";
  if (name.ends_with(".npy")) return "the magic of NPY";
  if (name.ends_with(".npz")) return "a zip archive of NPY files";
  if (name.ends_with(".mgh") || name.ends_with(".mgz")) return "an MGH header of version 1";
  if (is_mrc_name(name)) return "an MRC header with dimensions, mode and axes";
  if (name.ends_with(".h5") || name.ends_with(".hdf5")) return "the magic of HDF5";
  return "NRRD, MetaImage, NIfTI, Analyze, MGH, MRC, AmiraMesh, FITS, SLC, PVM, TIFF, PNG, DICOM, VTK, HDF5, NPY, NPZ, "
         "Zarr, N5 or raw with a layout";
}

// "scan.hdr" for "scan.img" or "scan.img.gz": the samples of a pair do not say what they are.
std::string header_of_image(const std::string& path) {
  std::string stem = path.ends_with(".gz") ? path.substr(0, path.size() - 3) : path;
  const bool capitals = stem.ends_with(".IMG");
  if (!capitals && !stem.ends_with(".img")) return {};
  stem.resize(stem.size() - 4);
  return stem + (capitals ? ".HDR" : ".hdr");
}

// Where a file of samples has a header beside it, names that one.
std::string header_beside(const std::string& path) {
  const std::string stem = path.substr(0, path.find_last_of('.'));
  for (const std::string_view ending : {".mhd", ".nhdr", ".MHD", ".NHDR"}) {
    const std::string header = stem + std::string(ending);
    if (header != path && system::facts_of_file(header)) return "; open its header instead, " + header;
  }
  return {};
}

// Opens formats without a magic, or with one that other data may begin with by chance.
OpenedVolume open_by_name(const FilePtr& file, std::string_view head, const OpenOptions& options) {
  const std::string& path = file->path();
  if (const std::optional<RawLayout> layout = raw_layout_from_name(path)) return open_raw(file, *layout);
  std::string name = lower_case(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  if (is_analyze(head)) {
    check_external(options, path, "its image");
    return open_analyze(file, options);
  }
  if (is_mgh(head)) return open_mgh(file, options);
  if (is_mrc_name(name) && is_old_mrc(head)) return open_mrc(file, options);
  if (name.ends_with(".mha") || name.ends_with(".mhd")) return open_metaimage(file, options);
  const std::string header = header_of_image(path);
  if (!header.empty()) {
    check_external(options, path, header);
    const FilePtr described = unpacked(open_part(path, "its header in", header));
    const bool nifti = is_nifti(described->head(kNiftiHeadBytes));
    OpenedVolume volume = nifti ? open_nifti(described, options) : open_analyze(described, options);
    volume.info.path = path;
    volume.info.data_files = {header};
    return volume;
  }
  bad_input(path, format_of_name(name), what_else(head, path) + header_beside(path));
}

OpenedVolume open_by_content(const FilePtr& file, const OpenOptions& options) {
  const std::string head = file->head(kHeadBytes);
  if (head.starts_with("NRRD")) return open_nrrd(file, options);
  if (is_tiff(head)) return open_tiff(jumping_file(file), false, options);
  if (is_png(head)) return open_png(file);
  if (is_vti(head)) return open_vti(jumping_file(file), options);
  if (is_vtk_legacy(head)) return open_vtk_legacy(jumping_file(file), options);
  if (is_pvm(head)) return open_pvm(jumping_file(file));
  if (is_metaimage(head)) return open_metaimage(file, options);
  refuse_other_magic(file->path(), head);
  if (is_nifti(head)) return open_nifti(file, options);
  if (is_npy(head)) return open_npy(file, options);
  if (is_npz(head, file->path())) return open_npz(jumping_file(file), options);
  if (is_mrc(head)) return open_mrc(file, options);
  if (is_amira(head)) return open_amira(file);
  if (is_slc(head)) return open_slc(file);
  if (is_fits(head)) return open_fits(file, options);
  if (is_hdf5(*file)) return open_hdf5(jumping_file(file), options);
  return open_by_name(file, head, options);
}

// Opens a DICOM series. A DICOM file on disk stands for the files beside it; the content of a pipe or a packed file
// does not.
OpenedVolume open_dicom(const FilePtr& file, const OpenOptions& options) {
  if (!file->jumps() || file->system_path() != file->path()) {
    bad_input(file->path(), "DICOM as a plain file or a folder of them", "DICOM in a pipe or in gzip");
  }
  const std::string& path = file->path();
  if (is_dicomdir(path)) {
    check_external(options, path, "the files of an export");
    return open_dicom_series(slices_of_export(path, options), options);
  }
  // Without others beside it, a file is all of its series.
  if (!options.external) return open_dicom_series({path, SliceKind::kDicom, {path}, {}}, options);
  return open_dicom_file(path, options);
}

// The content of a file. Samples without a header may begin as gzip does by chance; then their number is right.
FilePtr content_of(const FilePtr& stored, const OpenOptions& options) {
  const std::optional<RawLayout> layout = options.raw ? options.raw : raw_layout_from_name(stored->path());
  return layout && fits_raw(*stored, *layout) ? stored : unpacked(stored);
}

void refuse_series(const std::string& path, const std::string& series) {
  if (!series.empty()) bad_input(path, "the DICOM series " + in_quotes(series), "no DICOM");
}

bool is_one_of(std::string_view format, std::initializer_list<std::string_view> formats) {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

// Refuses options that choose among parts which the format does not have. Readers of formats that have such parts
// refuse a part that is not in the file.
void refuse_array_options(const VolumeInfo& info, const OpenOptions& options) {
  const bool array = is_one_of(info.format, {"hdf5", "zarr", "n5", "precomputed"});
  // The files of VTK and NumPy have arrays with names, and no levels.
  const bool named = array || is_one_of(info.format, {"vti", "vtr", "vtk", "npz"});
  if (!named && !options.dataset.empty()) {
    bad_input(info.path, "HDF5, Zarr, N5, VTI, VTR, legacy VTK or NPZ for --dataset", info.format);
  }
  if (!array && options.level) bad_input(info.path, "HDF5, Zarr, N5 or a precomputed volume for --level", info.format);
  const bool axes = array || is_one_of(info.format, {"npy", "npz", "tiff", "nifti", "nrrd", "metaimage", "analyze",
                                                     "mgh", "mrc", "fits", "dicom", "dicom-seg"});
  if (!axes && (options.channel || options.time || options.slices_from != SliceAxis::kSlices)) {
    bad_input(info.path,
              "NPY, NPZ, Analyze, MGH, MRC, FITS, TIFF, NIfTI, NRRD, MetaImage, DICOM, HDF5, Zarr or N5 for --channel, "
              "--time and --slices-from",
              info.format);
  }
}

OpenedVolume open_folder(const std::string& path, const OpenOptions& options) {
  if (is_folder(path) && is_array_folder(path)) {
    refuse_series(path, options.series);
    return open_zarr(path, options);
  }
  const SliceFiles slices = find_slices(path, options);
  if (slices.kind == SliceKind::kDicom) return open_dicom_series(slices, options);
  refuse_series(path, options.series);
  return open_slice_series(slices, options);
}

OpenedVolume open_single(const FilePtr& stored, const OpenOptions& options) {
  const FilePtr file = content_of(stored, options);
  if (options.raw) return open_raw(file, *options.raw);
  if (is_dicom(file->head(kDicomHeadBytes))) return open_dicom(file, options);
  refuse_series(file->path(), options.series);
  return open_by_content(file, options);
}

OpenedVolume open_any(const std::string& path, const OpenOptions& options) {
  const bool several = is_folder(path) || is_pattern(path);
  if (several && options.raw) return open_raw_slices(path, options);
  if (several) return open_folder(path, options);
  const FilePtr input = open_input_file(path);
  OpenedVolume volume = open_single(input, options);
  volume.input = input;
  return volume;
}

std::unique_ptr<SliceSource> source_of(OpenedVolume volume, const OpenOptions& options) {
  refuse_array_options(volume.info, options);
  if (!volume.unit_conflict.empty() && !options.spacing) {
    bad_input(volume.info.path, "units of length that can be made one, or --spacing", volume.unit_conflict);
  }
  apply_overrides(volume.info, options);
  return std::make_unique<StreamSource>(std::move(volume));
}

}  // namespace

std::unique_ptr<SliceSource> open_volume(const std::string& path, const OpenOptions& options) {
  const StandardFloats floats;
  if (is_url(path)) return open_remote_volume(path, options, remote_options());
  return source_of(open_any(path, options), options);
}

std::unique_ptr<SliceSource> open_remote_volume(const std::string& url, const OpenOptions& options,
                                                const RemoteOptions& remote) {
  const StandardFloats floats;
  const std::string shown = shown_url(url);
  if (!is_url(url)) bad_input(url, "a URL that begins with http://, https://, s3:// or gs://", "another path");
  refuse_series(shown, options.series);
  if (options.raw) bad_input(shown, "a file, which --raw describes", "a URL");
  return source_of(open_array(open_remote_store(url, remote), shown, options), options);
}

}  // namespace isoweave
