// Legacy VTK files with structured points: lines of text, then one array in text or in binary with the most significant
// byte first.
#include <bit>
#include <map>
#include <string>
#include <vector>

#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"
#include "volume/vtk_streams.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kMagic = "# vtk DataFile Version";

struct LegacyHeader {
  bool text = false;
  std::map<std::string, std::string, std::less<>> fields;  // by keyword in capitals: the rest of its line
  std::uint64_t data = 0;

  const std::string& get(std::string_view key, const std::string& path) const {
    const auto found = fields.find(key);
    if (found == fields.end()) bad_input(path, std::string(key) + " in the header", "none");
    return found->second;
  }
};

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return result;
}

std::string next_line(LineReader& lines, const std::string& path) {
  const auto line = lines.next();
  if (!line || !lines.ended()) bad_input(path, "a header up to SCALARS and LOOKUP_TABLE", "its end missing");
  return std::string(trimmed(*line));
}

LegacyHeader read_header(const FilePtr& file) {
  const std::string& path = file->path();
  const std::string head = file->head(kLargestHeader);
  LineReader lines(head);
  next_line(lines, path);
  next_line(lines, path);
  LegacyHeader header;
  const std::string form = upper_case(next_line(lines, path));
  if (form != "ASCII" && form != "BINARY") bad_input(path, "ASCII or BINARY in the third line", quoted(form));
  header.text = form == "ASCII";
  while (!header.fields.contains("LOOKUP_TABLE")) {
    const std::string line = next_line(lines, path);
    if (line.empty()) continue;
    const std::string key = upper_case(line.substr(0, line.find(' ')));
    if (key == "FIELD" || key == "CELL_DATA" || key == "VECTORS" || key == "COLOR_SCALARS") {
      bad_input(path, "SCALARS as the first array of POINT_DATA", quoted(key));
    }
    header.fields[key] = std::string(trimmed(std::string_view(line).substr(std::min(key.size(), line.size()))));
  }
  header.data = lines.position();
  return header;
}

std::vector<double> numbers_of(const std::string& text, std::string_view what, const std::string& path) {
  std::vector<double> numbers;
  for (const std::string_view word : words_of(text)) {
    const auto number = parse_double(word);
    if (!number) bad_input(path, "numbers as " + std::string(what), quoted(word));
    numbers.push_back(*number);
  }
  if (numbers.size() != 3) bad_input(path, "3 numbers as " + std::string(what), quoted(text));
  return numbers;
}

void set_place(VolumeInfo& info, const LegacyHeader& header) {
  const std::string& set = header.get("DATASET", info.path);
  if (upper_case(set) != "STRUCTURED_POINTS") bad_input(info.path, "DATASET STRUCTURED_POINTS", quoted(set));
  const std::vector<std::string_view> sides = words_of(header.get("DIMENSIONS", info.path));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto side = sides.size() == 3 ? parse_integer(sides[axis]) : std::nullopt;
    if (!side) bad_input(info.path, "3 whole numbers as DIMENSIONS", quoted(header.get("DIMENSIONS", info.path)));
    info.dims[axis] = *side;
  }
  // Version 1 had the name of the spacing.
  const bool old = !header.fields.contains("SPACING") && header.fields.contains("ASPECT_RATIO");
  const auto spacing = numbers_of(header.get(old ? "ASPECT_RATIO" : "SPACING", info.path), "SPACING", info.path);
  const auto origin = numbers_of(header.get("ORIGIN", info.path), "ORIGIN", info.path);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes.steps[axis][axis] = spacing[axis];
    axes.origin[axis] = origin[axis];
  }
  set_geometry(info.geometry, axes, info.path);
}

// "name type [components]"
SampleType sample_type_of(const std::string& scalars, std::string_view path) {
  static const std::map<std::string, SampleType, std::less<>> kTypes{{"char", SampleType::kInt8},
                                                                     {"signed_char", SampleType::kInt8},
                                                                     {"unsigned_char", SampleType::kUint8},
                                                                     {"short", SampleType::kInt16},
                                                                     {"unsigned_short", SampleType::kUint16},
                                                                     {"int", SampleType::kInt32},
                                                                     {"unsigned_int", SampleType::kUint32},
                                                                     {"float", SampleType::kFloat32},
                                                                     {"double", SampleType::kFloat64}};
  const std::vector<std::string_view> words = words_of(scalars);
  const auto found = words.size() < 2 ? kTypes.end() : kTypes.find(lower_case(words[1]));
  if (found == kTypes.end()) bad_input(path, "SCALARS of char to int, float or double", quoted(scalars));
  if (words.size() > 2 && words[2] != "1") bad_input(path, "one component per sample", quoted(words[2]));
  return found->second;
}

}  // namespace

bool is_vtk_legacy(std::string_view head) { return head.starts_with(kMagic); }

OpenedVolume open_vtk_legacy(const FilePtr& file) {
  const LegacyHeader header = read_header(file);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "vtk";
  set_place(info, header);
  info.type = sample_type_of(header.get("SCALARS", info.path), info.path);
  const std::uint64_t bytes = checked_volume_bytes(info);
  const std::uint64_t samples = bytes / sample_bytes(info.type);
  const auto points = parse_integer(header.get("POINT_DATA", info.path));
  if (!points || static_cast<std::uint64_t>(*points) != samples) {
    bad_input(info.path, "POINT_DATA " + std::to_string(samples), quoted(header.get("POINT_DATA", info.path)));
  }
  const std::uint64_t left = file->size() - header.data;
  if (header.text) {
    // A digit and a blank for each sample.
    check_plausible(info.path, 2 * samples, left + 1, 1);
    auto text = std::make_unique<FileStream>(file, header.data, file->size());
    volume.samples = std::make_unique<NumberStream>(std::move(text), info.type, samples, info.path);
    return volume;
  }
  if (left < bytes) bad_input(info.path, std::to_string(bytes) + " bytes of samples", std::to_string(left));
  volume.samples = std::make_unique<FileStream>(file, header.data, header.data + bytes);
  volume.swap_bytes = std::endian::native == std::endian::little;
  return volume;
}

}  // namespace isoweave
