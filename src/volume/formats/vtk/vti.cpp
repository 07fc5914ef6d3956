// VTI and VTR, VTK's XML image data and rectilinear grids, and PVTI and PVTR, which name files for their pieces. Tags
// are read up to the array that is wanted, where it has all samples; else all of them.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/external_files.hpp"
#include "files/header_text.hpp"
#include "files/part_file.hpp"
#include "files/quoted.hpp"
#include "files/xml_tag.hpp"
#include "volume/axes.hpp"
#include "volume/data_files.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/vtk/vtk_arrays.hpp"
#include "volume/formats/vtk/vtk_xml.hpp"
#include "volume/grid_coordinates.hpp"
#include "volume/piece_stream.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kRead = "VTK XML of type ImageData or RectilinearGrid";
constexpr std::size_t kMostPieces = 4096;
constexpr std::uint64_t kLargestRatio = 8 * kLzmaRatio;  // of samples to bytes: packed bits

// Arrays at points or in cells.
struct ArrayList {
  std::string active;
  std::vector<VtkArray> all;

  VtkArrayNames names() const {
    VtkArrayNames names{active, {}};
    for (const VtkArray& array : all) names.all.push_back({array.name, array.components});
    return names;
  }
};

struct ImagePiece {
  std::string extent;
  std::string source;  // PVTI: the file that holds it
  ArrayList points, cells;
  std::vector<VtkArray> coordinates;  // of a rectilinear grid: x, y, z
};

struct ImageHeader {
  std::string path;
  FilePtr file;  // none: to be opened again
  VtkXmlForm form;
  VtkAppended appended;
  std::string whole_extent, origin, spacing, direction;
  std::size_t times = 1;
  std::vector<ImagePiece> pieces;

  bool is_grid() const { return form.type.ends_with("RectilinearGrid"); }
  bool is_list() const { return form.type.starts_with('P'); }
};

class HeaderReader {
 public:
  HeaderReader(const FilePtr& file, const std::string& wanted) : tags_(file), wanted_(wanted) {
    header_.path = file->path();
    header_.file = file;
  }

  ImageHeader read() {
    for (std::string tag = tags_.next(); !tag.empty() && take(tag); tag = tags_.next()) {
    }
    if (header_.pieces.empty()) bad_input(header_.path, "a piece of image data", "none");
    return std::move(header_);
  }

 private:
  // False when the tags behind this one do not matter.
  bool take(std::string_view tag) {
    const std::string_view name = vtk_tag_name(tag);
    if (name == "VTKFile") take_form(tag);
    if (name == header_.form.type) take_image(tag);
    if (name == "Piece") add_piece(tag);
    if (name == "PointData" || name == "CellData") begin_arrays(tag, name == "CellData");
    if (name == "/PointData" || name == "/CellData" || name == "/Piece") arrays_ = nullptr;
    if (name == "Coordinates" || name == "/Coordinates") in_coordinates_ = name == "Coordinates";
    if (name == "DataArray" && in_coordinates_) add_coordinates(tag);
    if (name == "DataArray" && arrays_ != nullptr) return add_array(tag);
    if (name != "AppendedData") return true;
    header_.appended = vtk_appended(tag, tags_.position(), *header_.file);
    return false;
  }

  void take_form(std::string_view tag) {
    header_.form = vtk_xml_form(tag, header_.path);
    const std::string& type = header_.form.type;
    for (const std::string_view mesh : {"PolyData", "PPolyData", "UnstructuredGrid", "PUnstructuredGrid"}) {
      if (type != mesh) continue;
      bad_input(header_.path, kRead, in_quotes(type) + ", a mesh: isoweave simplify takes it");
    }
    for (const std::string_view known : {"ImageData", "PImageData", "RectilinearGrid", "PRectilinearGrid"}) {
      if (type == known) return;
    }
    bad_input(header_.path, kRead, in_quotes(type));
  }

  void take_image(std::string_view tag) {
    header_.whole_extent = xml_attribute(tag, "WholeExtent");
    header_.origin = xml_attribute(tag, "Origin");
    header_.spacing = xml_attribute(tag, "Spacing");
    header_.direction = xml_attribute(tag, "Direction");
    const std::string times = xml_attribute(tag, "TimeValues");
    header_.times = std::max<std::size_t>(words_of(times).size(), 1);
  }

  void add_piece(std::string_view tag) {
    if (header_.pieces.size() == kMostPieces) {
      bad_input(header_.path, "at most " + std::to_string(kMostPieces) + " pieces", "more");
    }
    arrays_ = nullptr;
    ImagePiece& piece = header_.pieces.emplace_back();
    piece.extent = xml_attribute(tag, "Extent");
    if (piece.extent.empty()) piece.extent = header_.whole_extent;
    piece.source = xml_attribute(tag, "Source");
  }

  void add_coordinates(std::string_view tag) {
    constexpr std::size_t kAxes = 3;
    if (header_.pieces.empty()) bad_input(header_.path, "a piece of a grid before its coordinates", "none");
    std::vector<VtkArray>& coordinates = header_.pieces.back().coordinates;
    if (coordinates.size() == kAxes) bad_input(header_.path, "coordinates along three axes", "more");
    coordinates.push_back(vtk_array(tag, tags_.position(), header_.path));
  }

  void begin_arrays(std::string_view tag, bool cells) {
    if (header_.pieces.empty()) bad_input(header_.path, "a piece of image data before its arrays", "none");
    arrays_ = cells ? &header_.pieces.back().cells : &header_.pieces.back().points;
    arrays_->active = xml_attribute(tag, "Scalars");
  }

  // More tags would mean to read through the samples behind the one that is wanted.
  bool add_array(std::string_view tag) {
    const VtkArray array = vtk_array(tag, tags_.position(), header_.path);
    // A file with several times has a tag for each array and time; the first one counts.
    const bool again = std::any_of(arrays_->all.begin(), arrays_->all.end(),
                                   [&](const VtkArray& other) { return other.name == array.name; });
    if (again) return true;
    arrays_->all.push_back(array);
    const ImagePiece& piece = header_.pieces.front();
    return header_.is_grid() || header_.pieces.size() > 1 || arrays_ != &piece.points ||
           words_of(piece.extent) != words_of(header_.whole_extent) || array.format == VtkArray::Format::kAppended ||
           !would_choose(arrays_->names(), {array.name, array.components}, wanted_);
  }

  VtkTags tags_;
  std::string wanted_;
  ImageHeader header_;
  ArrayList* arrays_ = nullptr;  // those that are being read
  bool in_coordinates_ = false;
};

template <std::size_t kCount>
std::array<double, kCount> numbers_of(const std::string& text, std::string_view what, std::string_view path) {
  std::array<double, kCount> numbers{};
  const std::vector<std::string_view> words = words_of(text);
  for (std::size_t n = 0; n < std::min(kCount, words.size()); ++n) {
    const auto number = parse_double(words[n]);
    if (!number) bad_input(path, "numbers as " + std::string(what), in_quotes(words[n]));
    numbers[n] = *number;
  }
  if (words.size() != kCount) {
    bad_input(path, std::to_string(kCount) + " numbers as " + std::string(what), in_quotes(text));
  }
  return numbers;
}

using Extent = std::array<std::int64_t, 6>;  // first and last point along each axis

Extent extent_of(const std::string& text, std::string_view path) {
  Extent extent{};
  const std::vector<std::string_view> words = words_of(text);
  constexpr std::int64_t kFarthest = std::int64_t{1} << 40;
  bool sane = words.size() == extent.size();
  for (std::size_t n = 0; sane && n < extent.size(); ++n) {
    const auto number = parse_integer(words[n]);
    sane = number && *number > -kFarthest && *number < kFarthest;
    if (sane) extent[n] = *number;
  }
  if (!sane) bad_input(path, "six whole numbers as an extent", in_quotes(text));
  return extent;
}

// Whether cells lie between points along the axis; where there is one point only, the cells are as flat as the image.
bool has_cells_between(const Extent& whole, std::size_t axis) { return whole[2 * axis] != whole[2 * axis + 1]; }

// The samples of an extent, counted from the first of the whole one.
Region box_of(const Extent& extent, const Extent& whole, bool cells) {
  Region box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.first[axis] = extent[2 * axis] - whole[2 * axis];
    box.end[axis] = extent[2 * axis + 1] - whole[2 * axis] + (cells && has_cells_between(whole, axis) ? 0 : 1);
  }
  return box;
}

void set_place(VolumeInfo& info, const ImageHeader& header, const Extent& whole, bool cells) {
  const auto spacing = numbers_of<3>(header.spacing.empty() ? "1 1 1" : header.spacing, "Spacing", info.path);
  const auto direction =
      numbers_of<9>(header.direction.empty() ? "1 0 0 0 1 0 0 0 1" : header.direction, "Direction", info.path);
  Axes axes;
  axes.origin = numbers_of<3>(header.origin.empty() ? "0 0 0" : header.origin, "Origin", info.path);
  info.dims = box_of(whole, whole, cells).end;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = cells && has_cells_between(whole, axis) ? 0.5 : 0;
    for (std::size_t row = 0; row < 3; ++row) {
      axes.steps[axis][row] = direction[3 * row + axis] * spacing[axis];
      axes.origin[row] += axes.steps[axis][row] * (static_cast<double>(whole[2 * axis]) + half);
    }
  }
  set_geometry(info.geometry, axes, info.path);
}

bool is_bits(const VtkArray& array) { return array.type == "Bit"; }

SampleType sample_type_of(const VtkArray& array, std::string_view path) {
  const auto type = is_bits(array) ? SampleType::kUint8 : parse_sample_type(lower_case(array.type));
  if (!type) bad_input(path, "an array of integers of 8 bits or more, Bit, Float32 or Float64", in_quotes(array.type));
  return *type;
}

PieceSamples open_samples(const ImageHeader& header, const VtkArray& array, std::uint64_t samples) {
  const FilePtr file = header.file ? header.file : open_file(header.path);
  const SampleType type = sample_type_of(array, header.path);
  if (array.is_text()) {
    const std::uint64_t begin = vtk_array_begin(*file, array, header.appended);
    // A digit and a blank for each sample.
    check_plausible(header.path, 2 * samples, file->size() - std::min(begin, file->size()) + 1, 1);
    auto text = std::make_unique<FileStream>(file, begin, file->size());
    return {std::make_unique<NumberStream>(std::move(text), NumberText{type, samples}, header.path)};
  }
  if (is_bits(array)) {
    constexpr std::uint64_t kBits = 8;
    auto bytes = open_vtk_array(file, header.form, array, header.appended, (samples + kBits - 1) / kBits);
    return {std::make_unique<BitStream>(std::move(bytes), samples)};
  }
  const bool swap = header.form.big_endian != (std::endian::native == std::endian::big);
  return {open_vtk_array(file, header.form, array, header.appended, samples * sample_bytes(type)), swap};
}

std::uint64_t samples_in(const Region& box) {
  std::uint64_t samples = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    samples *= static_cast<std::uint64_t>(std::max<std::int64_t>(box.end[axis] - box.first[axis], 0));
  }
  return samples;
}

// Opens the array of the piece that is like the one that was chosen.
VolumePiece piece_of(const std::shared_ptr<const ImageHeader>& header, const ImagePiece& piece, const Region& box,
                     bool cells, const VtkArray& like) {
  const std::vector<VtkArray>& all = (cells ? piece.cells : piece.points).all;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const VtkArray& array) { return array.name == like.name; });
  if (samples_in(box) > 0 && (found == all.end() || found->type != like.type || found->components != 1)) {
    bad_input(header->path, "the array " + in_quotes(like.name) + " of type " + like.type + " in each piece",
              "a piece without");
  }
  if (samples_in(box) == 0) return {box};
  return {box, [header, array = *found, box] { return open_samples(*header, array, samples_in(box)); }};
}

using Headers = std::vector<std::shared_ptr<const ImageHeader>>;

// The headers of the files with pieces: the file itself, or those that it names.
Headers piece_headers(const std::shared_ptr<const ImageHeader>& header, const OpenOptions& options) {
  if (!header->is_list()) return {header};
  Headers headers;
  for (const ImagePiece& piece : header->pieces) {
    check_external(options, header->path, piece.source);
    if (piece.source.empty()) bad_input(header->path, "a file as Source of each piece", "none");
    const std::string path = listed_files(header->path, {piece.source}).name(0);
    auto source = std::make_shared<ImageHeader>(
        HeaderReader(open_part(header->path, "a piece in", path), options.dataset).read());
    const std::string wanted = header->form.type.substr(1);
    if (source->form.type != wanted) bad_input(source->path, "VTK XML of type " + wanted, source->form.type);
    // A file for each of many pieces would be more than a process may have open.
    source->file.reset();
    headers.push_back(std::move(source));
  }
  return headers;
}

std::uint64_t stored_bytes(const Headers& headers) {
  std::uint64_t bytes = 0;
  for (const auto& header : headers) bytes += (header->file ? header->file : open_file(header->path))->size();
  return bytes;
}

bool has_samples(const ImagePiece& piece, std::string_view path) {
  const Extent extent = extent_of(piece.extent, path);
  return extent[0] <= extent[1] && extent[2] <= extent[3] && extent[4] <= extent[5];
}

const ImagePiece& first_with_samples(const Headers& headers, std::string_view path) {
  for (const auto& header : headers) {
    for (const ImagePiece& piece : header->pieces) {
      if (has_samples(piece, header->path)) return piece;
    }
  }
  bad_input(path, "a piece with samples", "none");
}

// The coordinates of a piece, at their places among those of all points.
void take_coordinates(const ImageHeader& header, const ImagePiece& piece, const Extent& whole,
                      GridCoordinates& points) {
  if (!has_samples(piece, header.path)) return;
  if (piece.coordinates.size() != points.size()) {
    bad_input(header.path, "coordinates along three axes", std::to_string(piece.coordinates.size()));
  }
  const Region box = box_of(extent_of(piece.extent, header.path), whole, false);
  for (std::size_t axis = 0; axis < points.size(); ++axis) {
    const VtkArray& array = piece.coordinates[axis];
    const auto count = static_cast<std::uint64_t>(box.end[axis] - box.first[axis]);
    if (box.first[axis] < 0 || static_cast<std::uint64_t>(box.end[axis]) > points.at(axis).size()) {
      bad_input(header.path, "pieces within the whole extent", in_quotes(piece.extent));
    }
    const PieceSamples stored = open_samples(header, array, count);
    const std::vector<double> part =
        read_coordinates(*stored.stream, sample_type_of(array, header.path), stored.swap_bytes, count, header.path);
    std::copy(part.begin(), part.end(), points.at(axis).begin() + box.first[axis]);
  }
}

// The coordinates of all points. A coordinate that no piece gives stays NaN.
GridCoordinates coordinates_of(const Headers& headers, const Extent& whole, const std::string& path) {
  GridCoordinates points;
  const Region box = box_of(whole, whole, false);
  for (std::size_t axis = 0; axis < points.size(); ++axis) {
    const auto count = static_cast<std::uint64_t>(std::max<std::int64_t>(box.end[axis], 0));
    if (count > kMostCoordinates) bad_input(path, "at most 2^24 coordinates along an axis", std::to_string(count));
    points.at(axis).resize(static_cast<std::size_t>(count), std::numeric_limits<double>::quiet_NaN());
  }
  for (const auto& header : headers) {
    for (const ImagePiece& piece : header->pieces) take_coordinates(*header, piece, whole, points);
  }
  return points;
}

// Puts the samples of all pieces together; of one that has them all they are the stream itself.
void open_pieces(OpenedVolume& volume, std::vector<VolumePiece> pieces) {
  pieces = filling_pieces(std::move(pieces), volume.info.dims, volume.info.path);
  if (pieces.size() == 1) {
    PieceSamples samples = pieces.front().open();
    volume.samples = std::move(samples.stream);
    volume.swap_bytes = samples.swap_bytes;
    return;
  }
  // A slice, and what a piece has of it.
  volume.held_bytes = 2 * volume.info.slice_bytes();
  volume.samples = std::make_unique<PieceStream>(std::move(pieces), volume.info.dims, sample_bytes(volume.info.type),
                                                 volume.info.path);
}

}  // namespace

bool is_vti(std::string_view head) {
  const std::size_t tag = head.find("<VTKFile");
  // Whether the tag stands behind nothing but the XML declaration and comments.
  return tag != std::string_view::npos && trimmed(head).starts_with('<');
}

OpenedVolume open_vti(const FilePtr& file, const OpenOptions& options) {
  const auto header = std::make_shared<const ImageHeader>(HeaderReader(file, options.dataset).read());
  const Headers headers = piece_headers(header, options);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = header->is_grid() ? "vtr" : "vti";
  const ImagePiece& first = first_with_samples(headers, info.path);
  const VtkArrayNames points = first.points.names();
  const VtkArrayNames cells = first.cells.names();
  const VtkChoice choice = choose_vtk_array(points, cells, options.dataset, info.path);
  note_vtk_choice(info, points, cells, choice);
  if (header->times > 1) {
    info.notes.emplace_back("the first of " + std::to_string(header->times) + " times is read");
  }
  const VtkArray& like = (choice.cells ? first.cells : first.points).all[choice.array];
  info.type = sample_type_of(like, info.path);
  const Extent whole = extent_of(header->whole_extent, info.path);
  EvenGrid slices;
  if (header->is_grid()) {
    slices = place_on_grid(info, coordinates_of(headers, whole, info.path), choice.cells, options);
  } else {
    ImageHeader place = *header;
    if (place.direction.empty()) place.direction = headers.front()->direction;
    set_place(info, place, whole, choice.cells);
  }
  check_plausible(info.path, checked_volume_bytes(info), stored_bytes(headers), kLargestRatio);
  std::vector<VolumePiece> pieces;
  for (const auto& source : headers) {
    if (header->is_list()) info.data_files.push_back(source->path);
    for (const ImagePiece& piece : source->pieces) {
      pieces.push_back(piece_of(source, piece, box_of(extent_of(piece.extent, source->path), whole, choice.cells),
                                choice.cells, like));
    }
  }
  open_pieces(volume, std::move(pieces));
  take_even_slices(volume, slices);
  return volume;
}

}  // namespace isoweave
