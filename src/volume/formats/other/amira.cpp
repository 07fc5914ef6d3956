// AmiraMesh: a text header, then arrays behind their labels "@1", "@2", ... A volume is the first array over a lattice
// with uniform coordinates: plain, as text, in run lengths (HxByteRLE) or in zlib (HxZip).
#include <array>
#include <bit>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "files/length_units.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/formats/other/run_lengths.hpp"
#include "volume/text_streams.hpp"

namespace isoweave {
namespace {

struct AmiraHeader {
  std::string form;   // "ASCII", "BINARY" (big-endian) or "BINARY-LITTLE-ENDIAN"
  std::string sides;  // numbers of samples
  std::string box;    // first and last sample along x, y, z
  std::string unit;   // in quotes, as the newer programs write it
  std::string coordinates = "uniform";
  std::string type;   // of the array over the lattice
  std::string label;  // "@1"
  std::string codec;  // empty: none
  std::string codec_bytes;
  std::uint64_t data = 0;
};

// The text behind a word of a line, without what closes it; empty when the word is not there.
std::string_view behind(std::string_view line, std::string_view word) {
  const std::size_t at = line.find(word);
  if (at == std::string_view::npos) return {};
  std::string_view rest = trimmed(line.substr(at + word.size()));
  while (rest.ends_with(',') || rest.ends_with('}')) rest = trimmed(rest.substr(0, rest.size() - 1));
  return rest;
}

// "Lattice { byte Labels } @1(HxByteRLE,1234)", or with "= @1".
void take_array(AmiraHeader& header, std::string_view line) {
  const std::size_t open = line.find('{');
  const std::size_t close = line.find('}');
  const std::size_t label = line.find('@');
  if (open == std::string_view::npos || close == std::string_view::npos || label == std::string_view::npos) return;
  if (!header.label.empty() || open > close || close > label) return;
  const std::string_view inside = line.substr(open + 1, close - open - 1);
  const std::vector<std::string_view> words = words_of(inside);
  if (!words.empty()) header.type = words[0];
  const std::string_view name = trimmed(line.substr(label));
  const std::size_t packing = name.find('(');
  header.label = trimmed(name.substr(0, packing));
  if (packing == std::string_view::npos) return;
  const std::string_view inner = name.substr(packing + 1, name.find(')') - packing - 1);
  header.codec = trimmed(inner.substr(0, inner.find(',')));
  if (inner.find(',') != std::string_view::npos) header.codec_bytes = trimmed(inner.substr(inner.find(',') + 1));
}

// The numbers of "define Lattice 3 2 5"; what was found before where something else is defined.
std::string sides_of(std::string_view line, const std::string& before) {
  const std::vector<std::string_view> words = words_of(line);
  return words.size() > 1 && words[1] == "Lattice" ? std::string(behind(line, "Lattice")) : before;
}

AmiraHeader read_amira_header(const FilePtr& file) {
  const std::string head = file->head(kLargestHeader);
  LineReader lines(head);
  AmiraHeader header;
  for (const std::string_view word : words_of(lines.next().value_or(""))) {
    if (word == "ASCII" || word.starts_with("BINARY")) header.form = word;
  }
  while (const auto next = lines.next()) {
    const std::string_view line = trimmed(*next);
    if (line.starts_with("define") && words_of(line)[0] == "define") header.sides = sides_of(line, header.sides);
    if (line.starts_with("Coordinates")) header.unit = behind(line, "Coordinates");
    if (const auto box = behind(line, "BoundingBox"); !box.empty()) header.box = box;
    if (const auto kind = behind(line, "CoordType"); !kind.empty()) header.coordinates = kind;
    if (line.starts_with("Lattice")) take_array(header, line);
    if (!line.starts_with('@')) continue;
    header.data = lines.position();
    if (line != header.label) {
      bad_input(file->path(), "an array over a lattice as the first one",
                header.label.empty() ? "none" : in_quotes(line));
    }
    return header;
  }
  bad_input(file->path(), "samples behind '@1' in a line of its own", "the end of the file");
}

template <std::size_t kCount>
std::array<double, kCount> numbers_of(const std::string& text, std::string_view what, std::string_view path) {
  std::array<double, kCount> numbers{};
  const std::vector<std::string_view> words = words_of(text);
  bool sane = words.size() == kCount;
  for (std::size_t n = 0; sane && n < kCount; ++n) {
    const auto number = parse_double(words[n]);
    sane = number.has_value();
    if (sane) numbers[n] = *number;
  }
  if (!sane) bad_input(path, std::to_string(kCount) + " numbers as " + std::string(what), in_quotes(text));
  return numbers;
}

void set_dims(VolumeInfo& info, const AmiraHeader& header) {
  const std::vector<std::string_view> words = words_of(header.sides);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto side = words.size() == 3 ? parse_integer(words[axis]) : std::nullopt;
    if (!side) bad_input(info.path, "three whole numbers behind 'define Lattice'", in_quotes(header.sides));
    info.dims[axis] = *side;
  }
}

// How many of the unit that the volume is in one of the header is. Older files have none.
double scale_of_unit(VolumeInfo& info, std::string_view text) {
  while (text.starts_with('"')) text.remove_prefix(1);
  while (text.ends_with('"')) text.remove_suffix(1);
  if (text.empty()) return 1;
  const std::optional<LengthUnit> unit = find_metric_unit(text);
  if (!unit) {
    info.notes.push_back("the unit " + in_quotes(text) + " is no known length");
    return 1;
  }
  info.geometry.unit = unit->name;
  return unit->scale;
}

// The box ends at the first and the last sample, not at the sides of cells around them.
void set_axes(VolumeInfo& info, const AmiraHeader& header) {
  if (header.coordinates.find("uniform") == std::string::npos) {
    bad_input(info.path, "CoordType \"uniform\"", in_quotes(header.coordinates));
  }
  if (header.box.empty()) {
    info.notes.emplace_back("the spacing is not given and taken as 1");
    return;
  }
  const std::array<double, 6> box = numbers_of<6>(header.box, "BoundingBox", info.path);
  const double scale = scale_of_unit(info, header.unit);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = box[2 * axis + 1] - box[2 * axis];
    const double steps = static_cast<double>(info.dims[axis] - 1);
    axes.origin[axis] = scale * box[2 * axis];
    axes.steps[axis][axis] = steps > 0 ? scale * length / steps : 1;
  }
  set_geometry(info.geometry, axes, info.path);
}

SampleType sample_type_of(const std::string& name, std::string_view path) {
  static const std::map<std::string, SampleType, std::less<>> kTypes{
      {"byte", SampleType::kUint8}, {"short", SampleType::kInt16},   {"ushort", SampleType::kUint16},
      {"int", SampleType::kInt32},  {"float", SampleType::kFloat32}, {"double", SampleType::kFloat64}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end())
    bad_input(path, "one byte, short, ushort, int, float or double per sample", in_quotes(name));
  return found->second;
}

std::unique_ptr<ByteStream> unpacked_samples(const FilePtr& file, const AmiraHeader& header, std::uint64_t bytes) {
  const std::string& path = file->path();
  const auto size = parse_integer(header.codec_bytes);
  if (!size || *size < 1) bad_input(path, "the bytes that an array is packed in", in_quotes(header.codec_bytes));
  const auto stored = static_cast<std::uint64_t>(*size);
  auto packed = samples_in(file, header.data, stored);
  if (header.codec == "HxByteRLE") {
    check_plausible(path, bytes, stored, kRunRatio);
    return std::make_unique<RunStream>(std::move(packed));
  }
  if (header.codec != "HxZip") bad_input(path, "an array plain, in HxByteRLE or in HxZip", in_quotes(header.codec));
  check_plausible(path, bytes, stored, kDeflateRatio);
  return std::make_unique<InflateStream>(std::move(packed), path);
}

std::unique_ptr<ByteStream> samples_of(const FilePtr& file, const AmiraHeader& header, const VolumeInfo& info,
                                       std::uint64_t bytes) {
  if (!header.codec.empty()) return unpacked_samples(file, header, bytes);
  if (header.form != "ASCII") return samples_in(file, header.data, bytes);
  const std::uint64_t samples = bytes / sample_bytes(info.type);
  // A digit and a blank for each sample.
  check_plausible(info.path, 2 * samples, file->size() - std::min(header.data, file->size()) + 1, 1);
  auto text = std::make_unique<FileStream>(file, header.data, file->size());
  return std::make_unique<NumberStream>(std::move(text), NumberText{info.type, samples}, info.path);
}

}  // namespace

bool is_amira(std::string_view head) { return head.starts_with("# AmiraMesh") || head.starts_with("# Avizo"); }

OpenedVolume open_amira(const FilePtr& file) {
  const AmiraHeader header = read_amira_header(file);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "amira";
  const bool little = header.form == "BINARY-LITTLE-ENDIAN";
  if (header.form != "ASCII" && header.form != "BINARY" && !little) {
    bad_input(info.path, "ASCII, BINARY or BINARY-LITTLE-ENDIAN in the first line", in_quotes(header.form));
  }
  info.type = sample_type_of(header.type, info.path);
  set_dims(info, header);
  const std::uint64_t bytes = checked_volume_bytes(info);
  set_axes(info, header);
  volume.samples = samples_of(file, header, info, bytes);
  volume.swap_bytes = header.form != "ASCII" && little != (std::endian::native == std::endian::little);
  return volume;
}

}  // namespace isoweave
