// MetaImage: "Key = value" lines that end with ElementDataFile, then the samples or the names of their files.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/external_files.hpp"
#include "files/header_text.hpp"
#include "files/length_units.hpp"
#include "files/part_file.hpp"
#include "files/quoted.hpp"
#include "volume/axes.hpp"
#include "volume/data_files.hpp"
#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/formats.hpp"
#include "volume/picked_stream.hpp"

namespace isoweave {
namespace {

struct MetaFields {
  std::map<std::string, std::string> values;  // keys in lower case
  std::vector<std::string> listed;            // the lines behind the last key
  std::size_t end = 0;                        // bytes of the header

  // The value of the first key that is there: several have older names.
  std::string_view get(std::initializer_list<const char*> keys) const {
    for (const char* key : keys) {
      const auto found = values.find(key);
      if (found != values.end()) return found->second;
    }
    return {};
  }
};

constexpr const char* kDataFile = "elementdatafile";

bool is_list(std::string_view value) {
  const auto words = words_of(value);
  return !words.empty() && lower_case(words[0]) == "list";
}

void read_list(MetaFields& fields, LineReader& lines) {
  while (const auto line = lines.next()) {
    const std::string_view name = trimmed(*line);
    if (!name.empty()) fields.listed.emplace_back(name);
  }
}

MetaFields parse_fields(const std::string& text, std::string_view path) {
  MetaFields fields;
  LineReader lines(text);
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    const std::size_t equals = line->find('=');
    if (equals == std::string_view::npos) {
      bad_input(path, "header lines 'Key = value'", in_quotes(*line));
    }
    const std::string key = lower_case(trimmed(line->substr(0, equals)));
    fields.values[key] = trimmed(line->substr(equals + 1));
    if (key != kDataFile) continue;
    if (fields.get({kDataFile}).empty()) bad_input(path, "LOCAL, LIST or a file behind ElementDataFile", "nothing");
    fields.end = lines.position();
    if (is_list(fields.get({kDataFile}))) read_list(fields, lines);
    return fields;
  }
  bad_input(path, "ElementDataFile as the last key of the header",
            "none in its first " + std::to_string(text.size()) + " bytes");
}

bool is_true(std::string_view text) {
  const std::string value = lower_case(text);
  return value == "true" || value == "t" || value == "1";
}

std::optional<std::int64_t> integer_of(const MetaFields& fields, std::initializer_list<const char*> keys,
                                       std::string_view path) {
  const std::string_view text = fields.get(keys);
  if (text.empty()) return std::nullopt;
  const auto value = parse_integer(text);
  if (!value) bad_input(path, "a whole number as " + std::string(*keys.begin()), in_quotes(text));
  return value;
}

// Numbers of a list field; empty when it is not there.
std::vector<double> numbers_of(const MetaFields& fields, std::initializer_list<const char*> keys, std::size_t count,
                               std::string_view path) {
  std::vector<double> numbers;
  for (const std::string_view word : words_of(fields.get(keys))) {
    const auto number = parse_double(word);
    if (!number) bad_input(path, "numbers in " + std::string(*keys.begin()), in_quotes(word));
    numbers.push_back(*number);
  }
  if (!numbers.empty() && numbers.size() != count) {
    bad_input(path, std::to_string(count) + " numbers in " + std::string(*keys.begin()),
              std::to_string(numbers.size()));
  }
  return numbers;
}

SampleType sample_type_of(const MetaFields& fields, std::string_view path) {
  // MET_LONG is four bytes in every version of the format; eight are MET_LONG_LONG.
  static const std::map<std::string_view, SampleType> kTypes{
      {"met_char", SampleType::kInt8},         {"met_uchar", SampleType::kUint8},
      {"met_short", SampleType::kInt16},       {"met_ushort", SampleType::kUint16},
      {"met_int", SampleType::kInt32},         {"met_uint", SampleType::kUint32},
      {"met_long", SampleType::kInt32},        {"met_ulong", SampleType::kUint32},
      {"met_float", SampleType::kFloat32},     {"met_long_long", SampleType::kInt64},
      {"met_ulong_long", SampleType::kUint64}, {"met_double", SampleType::kFloat64}};
  const std::string_view text = fields.get({"elementtype"});
  const std::string name = lower_case(text);
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) {
    bad_input(path, "an ElementType of 8 to 64 bit integers, MET_FLOAT or MET_DOUBLE", in_quotes(text));
  }
  return found->second;
}

void check_kind(const MetaFields& fields, std::string_view path) {
  const std::string_view object = fields.get({"objecttype"});
  if (!object.empty() && lower_case(object) != "image") {
    bad_input(path, "ObjectType Image", in_quotes(object));
  }
  const std::string_view binary = fields.get({"binarydata"});
  if (!binary.empty() && !is_true(binary)) bad_input(path, "BinaryData True", in_quotes(binary));
}

// Values of one sample, which lie together. They are no choice of volumes, unless the caller chooses.
std::int64_t channels_of(const MetaFields& fields, const OpenOptions& options, std::string_view path) {
  const std::int64_t channels = integer_of(fields, {"elementnumberofchannels"}, path).value_or(1);
  if (channels < 1 || (channels > 1 && !options.channel)) {
    bad_input(path, "one channel per sample", std::to_string(channels) + " channels (--channel chooses one)");
  }
  return channels;
}

// The axes from the slowest to the fastest: the fourth one is time, and further ones have one sample.
std::vector<ArrayAxis> axes_of(const MetaFields& fields, const OpenOptions& options, std::string_view path) {
  const std::vector<std::string_view> words = words_of(fields.get({"dimsize"}));
  const std::int64_t axes = integer_of(fields, {"ndims"}, path).value_or(0);
  constexpr std::int64_t kMostAxes = 10;
  if (axes < 1 || axes > kMostAxes || words.size() != static_cast<std::size_t>(axes)) {
    bad_input(path, "NDims of 1 to 10 and as many numbers in DimSize",
              "NDims " + std::to_string(axes) + " and " + std::to_string(words.size()) + " numbers");
  }
  constexpr std::array<const char*, 4> kNames{"x", "y", "z", "time"};
  std::vector<ArrayAxis> named{{channels_of(fields, options, path), "channel"}};
  for (std::size_t n = 0; n < words.size(); ++n) {
    const auto side = parse_integer(words[n]);
    if (!side || *side < 1) bad_input(path, "DimSize of at least 1", in_quotes(words[n]));
    if (n >= kNames.size() && *side > 1) {
      bad_input(path, "3 dimensions, or 4 with time",
                "axis " + std::to_string(n) + " with " + std::to_string(*side) + " samples");
    }
    if (n < kNames.size()) named.push_back({*side, kNames[n]});
  }
  // A line is a plane of one row.
  if (words.size() == 1) named.push_back({1, "y"});
  std::reverse(named.begin(), named.end());
  return named;
}

// ElementSize is the extent of a sample, which is the distance of samples where nothing else is said.
std::vector<double> spacing_of(VolumeInfo& info, const MetaFields& fields, std::size_t axes) {
  auto spacing = numbers_of(fields, {"elementspacing"}, axes, info.path);
  auto size = numbers_of(fields, {"elementsize"}, axes, info.path);
  if (spacing.empty() && size.empty()) info.notes.emplace_back("the spacing is not given and taken as 1");
  if (spacing.empty()) return size;
  constexpr double kRounding = 1e-3;
  for (std::size_t n = 0; n < std::min<std::size_t>(size.size(), 3); ++n) {
    if (std::abs(size[n] - spacing[n]) <= kRounding * std::abs(spacing[n])) continue;
    info.notes.push_back("the spacing of axis " + std::to_string(n) + " is " + rounded_text(spacing[n]) +
                         " by ElementSpacing, which is taken, and " + rounded_text(size[n]) + " by ElementSize");
  }
  return spacing;
}

void set_axes(OpenedVolume& volume, const MetaFields& fields, std::size_t axes) {
  VolumeInfo& info = volume.info;
  const auto matrix = numbers_of(fields, {"transformmatrix", "rotation", "orientation"}, axes * axes, info.path);
  const auto origin = numbers_of(fields, {"offset", "position", "origin"}, axes, info.path);
  const std::vector<double> spacing = spacing_of(info, fields, axes);
  // The text that MetaIO writes where it knows no value.
  constexpr std::string_view kUnknown = "?";
  const std::string_view given = fields.get({"distanceunits"});
  const std::string text(given == kUnknown ? std::string_view() : given);
  const CommonUnit unit = common_unit({text, text, text});
  Axes out;
  const std::size_t used = std::min<std::size_t>(axes, 3);
  for (std::size_t n = 0; n < used; ++n) {
    for (std::size_t row = 0; row < used; ++row) {
      // The file lists the directions of the axes one after another.
      if (!matrix.empty()) out.steps[n][row] = matrix[n * axes + row];
    }
    for (double& component : out.steps[n]) component *= (spacing.empty() ? 1 : spacing[n]) * unit.scale[n];
    if (!origin.empty()) out.origin[n] = origin[n] * unit.scale[n];
  }
  set_geometry(info.geometry, out, info.path);
  info.geometry.space = Space::kLps;
  take_unit(volume, unit);
}

// ITK passes over the scaling from samples to intensities, so its programs show samples as they are stored.
void note_intensities(VolumeInfo& info, const MetaFields& fields) {
  const auto slope = numbers_of(fields, {"elementtointensityfunctionslope"}, 1, info.path);
  const auto offset = numbers_of(fields, {"elementtointensityfunctionoffset"}, 1, info.path);
  const bool scales = (!slope.empty() && slope[0] != 1) || (!offset.empty() && offset[0] != 0);
  if (!scales) return;
  info.notes.push_back("the header scales samples to intensities by " + number_text(slope.empty() ? 1 : slope[0]) +
                       " and " + number_text(offset.empty() ? 0 : offset[0]) +
                       " (ElementToIntensityFunction), which is not applied");
}

// HeaderSize counts bytes of the file as stored; -1 means that the samples end the file.
std::uint64_t compressed_begin(const FilePtr& file, const MetaFields& fields, std::int64_t header_size) {
  if (header_size >= 0) return static_cast<std::uint64_t>(header_size);
  const auto stored = integer_of(fields, {"compresseddatasize"}, file->path());
  if (!stored || *stored < 1 || static_cast<std::uint64_t>(*stored) > file->exact_size()) {
    bad_input(file->path(), "a CompressedDataSize within the file, for HeaderSize -1", "none");
  }
  return file->exact_size() - static_cast<std::uint64_t>(*stored);
}

// Notes it where the packed samples, behind the header or in the one other file, are not as long as the header says.
// The number is not needed: the stream ends by itself.
void note_compressed_size(VolumeInfo& info, const FilePtr& file, const MetaFields& fields) {
  const std::string value = lower_case(fields.get({kDataFile}));
  const auto said = integer_of(fields, {"compresseddatasize"}, info.path);
  const bool local = value == "local";
  if (!said || !is_true(fields.get({"compresseddata"})) || is_list(value) || value.find('%') != std::string::npos)
    return;
  const std::int64_t skip =
      local ? static_cast<std::int64_t>(fields.end) : integer_of(fields, {"headersize"}, info.path).value_or(0);
  if (skip < 0) return;
  const FilePtr data =
      local ? file : open_part(info.path, "its samples in", beside(info.path, std::string(fields.get({kDataFile}))));
  const auto found = static_cast<std::int64_t>(data->exact_size()) - skip;
  if (found == *said) return;
  info.notes.push_back("CompressedDataSize is " + std::to_string(*said) + ", and the file has " +
                       std::to_string(found) + " bytes of compressed samples, which are read");
}

// "name%03d.raw 1 100 1", where the step may be missing.
std::optional<DataFiles> metaimage_series(std::string_view value, const std::string& path) {
  const std::vector<std::string_view> words = words_of(value);
  if (words.size() < 3 || words.size() > 4 || words[0].find('%') == std::string_view::npos) return std::nullopt;
  std::vector<std::int64_t> numbers;
  for (std::size_t n = 1; n < words.size(); ++n) {
    const auto number = parse_integer(words[n]);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  if (numbers.size() == 2) numbers.push_back(1);
  return numbered_files(path, std::string(words[0]), numbers);
}

std::unique_ptr<ByteStream> samples_of(VolumeInfo& info, const FilePtr& file, const MetaFields& fields,
                                       std::uint64_t bytes) {
  const std::string& path = file->path();
  const std::string value(fields.get({kDataFile}));
  DataLayout layout;
  if (is_true(fields.get({"compresseddata"}))) layout.encoding = DataLayout::Encoding::kDeflate;
  layout.byte_skip = integer_of(fields, {"headersize"}, path).value_or(0);
  if (layout.byte_skip < -1) bad_input(path, "a HeaderSize of at least -1", std::to_string(layout.byte_skip));
  if (lower_case(value) == "local") {
    layout.byte_skip = 0;
    return open_only_file(info, file, fields.end, layout, bytes);
  }
  if (is_list(value)) return open_samples(info, listed_files(path, fields.listed), layout, bytes);
  if (const auto series = metaimage_series(value, path)) return open_samples(info, *series, layout, bytes);
  const FilePtr data = open_part(path, "its samples in", beside(path, value));
  if (layout.encoding == DataLayout::Encoding::kRaw) return open_only_file(info, data, 0, layout, bytes);
  const std::uint64_t begin = compressed_begin(data, fields, std::exchange(layout.byte_skip, 0));
  info.data_files = {data->path()};
  return open_samples(data, begin, layout, bytes);
}

}  // namespace

bool is_metaimage(std::string_view head) {
  const std::string_view line = LineReader(head).next().value_or("");
  const std::string key = lower_case(trimmed(line.substr(0, line.find('='))));
  static constexpr std::array<std::string_view, 6> kFirstKeys{"objecttype",    "ndims",         "comment",
                                                              "objectsubtype", "transformtype", "name"};
  const bool known = std::find(kFirstKeys.begin(), kFirstKeys.end(), key) != kFirstKeys.end();
  return known && line.find('=') != std::string_view::npos;
}

OpenedVolume open_metaimage(const FilePtr& file, const OpenOptions& options) {
  const MetaFields fields = parse_fields(file->head(kLargestHeader), file->path());
  check_kind(fields, file->path());
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "metaimage";
  info.type = sample_type_of(fields, info.path);
  const std::vector<ArrayAxis> axes = axes_of(fields, options, info.path);
  const AxisChoice choice = choose_axes(axes, options, info.path);
  info.dims = choice.dims(axes);
  info.part = choice.part;
  info.notes = choice.notes;
  set_axes(volume, fields, words_of(fields.get({"dimsize"})).size());
  const std::string_view data = fields.get({kDataFile});
  if (lower_case(data) != "local") check_external(options, info.path, data);
  note_compressed_size(info, file, fields);
  note_intensities(info, fields);
  const bool big = is_true(fields.get({"binarydatabyteordermsb", "elementbyteordermsb"}));
  volume.swap_bytes = big != (std::endian::native == std::endian::big);
  const std::size_t each = sample_bytes(info.type);
  auto samples = samples_of(info, file, fields, checked_bytes_of(axes, each, info.path));
  volume.samples = pick_volume(std::move(samples), axes, choice, each, info.path);
  return volume;
}

}  // namespace isoweave
