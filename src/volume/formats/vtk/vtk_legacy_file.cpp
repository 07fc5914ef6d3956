#include "volume/formats/vtk/vtk_legacy_file.hpp"

#include <algorithm>
#include <utility>

#include "files/header_text.hpp"
#include "files/quoted.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kLongestLine = 1 << 16;
constexpr std::uint64_t kMost = std::uint64_t{1} << 48;

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return result;
}

// VTK writes blanks and the like in names as "%20", and some as "%%20".
std::string plain_name(std::string_view name) {
  const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1; };
  std::string plain;
  for (std::size_t n = 0; n < name.size(); ++n) {
    if (name[n] == '%' && n + 1 < name.size() && name[n + 1] == '%') ++n;
    const int high = n + 2 < name.size() ? digit(name[n + 1]) : -1;
    const int low = n + 2 < name.size() ? digit(name[n + 2]) : -1;
    const bool is_code = name[n] == '%' && high >= 0 && low >= 0;
    plain += is_code ? static_cast<char>(high * 16 + low) : name[n];
    if (is_code) n += 2;
  }
  return plain;
}

std::size_t bits_of(std::string_view type) {
  if (type == "Bit") return 1;
  for (const std::size_t bits : {8U, 16U, 32U, 64U}) {
    if (type.ends_with(std::to_string(bits))) return bits;
  }
  return 0;
}

}  // namespace

VtkArrayNames LegacyArrays::names() const {
  VtkArrayNames names;
  for (const LegacyArray& array : all) {
    names.all.push_back({array.name, static_cast<std::int64_t>(array.components)});
    if (array.is_scalars && array.components == 1 && names.active.empty()) names.active = array.name;
  }
  return names;
}

LegacyFile::LegacyFile(std::shared_ptr<const InputFile> file) : file_(std::move(file)) {
  std::string line;
  next_line(line);
  next_line(line);
  next_line(line);
  const std::string form = upper_case(trimmed(line));
  if (form != "ASCII" && form != "BINARY") bad_input(path(), "ASCII or BINARY in the third line", in_quotes(form));
  is_text_ = form == "ASCII";
}

int LegacyFile::take() {
  if (position_ < begin_ || position_ >= begin_ + filled_) {
    begin_ = position_;
    filled_ = file_->read_at(begin_, buffer_);
    if (filled_ == 0) return -1;
  }
  return std::to_integer<int>(buffer_[static_cast<std::size_t>(position_++ - begin_)]);
}

// False at the end of the file.
bool LegacyFile::next_line(std::string& line) {
  line.clear();
  int c = take();
  if (c < 0) return false;
  for (; c >= 0 && c != '\n'; c = take()) {
    if (line.size() == kLongestLine) bad_input(path(), "lines of up to 65536 characters", "a longer one");
    line.push_back(static_cast<char>(c));
  }
  return true;
}

std::string legacy_key(const std::vector<std::string>& words) {
  return words.empty() ? std::string() : upper_case(words.front());
}

std::vector<std::string> LegacyFile::next_words() {
  if (pending_) skip(*std::exchange(pending_, std::nullopt));
  std::string line;
  while (next_line(line)) {
    std::vector<std::string> words;
    for (const std::string_view word : words_of(line)) words.emplace_back(word);
    if (!words.empty()) return words;
  }
  return {};
}

bool LegacyFile::is_next(std::string_view text) {
  constexpr std::size_t kBlanks = 8;
  std::string head(kBlanks + text.size(), '\0');
  head.resize(file_->read_at(position_, std::as_writable_bytes(std::span(head))));
  return upper_case(trimmed(head)).starts_with(text);
}

std::uint64_t LegacyFile::count_of(const std::vector<std::string>& words, std::size_t word) const {
  const auto count = word < words.size() ? parse_integer(words[word]) : std::nullopt;
  if (!count || *count < 0 || static_cast<std::uint64_t>(*count) > kMost) {
    bad_input(path(), "a whole number behind " + in_quotes(words[0]),
              word < words.size() ? in_quotes(words[word]) : "nothing");
  }
  return static_cast<std::uint64_t>(*count);
}

// Whether a line ends behind so many bytes, or the file.
bool LegacyFile::ends_after(std::uint64_t bytes) {
  if (position_ > file_->size() || bytes > file_->size() - position_) return false;
  std::array<std::byte, 1> next{std::byte{'\n'}};
  file_->read_at(position_ + bytes, next);
  return next[0] == std::byte{'\n'} || next[0] == std::byte{'\r'};
}

// "long" has 8 bytes on most systems and 4 on others; what stands behind the array tells.
std::string LegacyFile::type_here(std::string_view type, std::uint64_t numbers) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kTypes{{{"bit", "Bit"},
                                                                                         {"char", "Int8"},
                                                                                         {"signed_char", "Int8"},
                                                                                         {"unsigned_char", "UInt8"},
                                                                                         {"short", "Int16"},
                                                                                         {"unsigned_short", "UInt16"},
                                                                                         {"int", "Int32"},
                                                                                         {"unsigned_int", "UInt32"},
                                                                                         {"vtkidtype", "Int32"},
                                                                                         {"vtktypeint64", "Int64"},
                                                                                         {"vtktypeuint64", "UInt64"},
                                                                                         {"float", "Float32"},
                                                                                         {"double", "Float64"},
                                                                                         {"string", "String"},
                                                                                         {"utf8_string", "String"}}};
  const std::string name = lower_case(type);
  if (name == "long" || name == "unsigned_long") {
    const bool is_wide = is_text_ || ends_after(8 * numbers) || !ends_after(4 * numbers);
    return std::string(name == "long" ? "Int" : "UInt") + (is_wide ? "64" : "32");
  }
  for (const auto& [legacy, xml] : kTypes) {
    if (legacy == name) return std::string(xml);
  }
  bad_input(path(), "a type of VTK", in_quotes(type));
}

LegacyArray LegacyFile::array_here(const std::string& name, std::string_view type, std::uint64_t components,
                                   std::uint64_t tuples) {
  constexpr std::uint64_t kMostComponents = 1 << 12;
  if (components == 0 || components > kMostComponents || tuples > kMost / components) {
    bad_input(path(), "arrays of 1 to 4096 components and at most 2^48 numbers",
              std::to_string(components) + " of " + std::to_string(tuples) + " tuples");
  }
  LegacyArray array;
  array.name = plain_name(name);
  array.components = components;
  array.tuples = tuples;
  array.type = type_here(type, array.numbers());
  array.at = position_;
  return array;
}

void LegacyFile::skip_words(std::uint64_t count) {
  const auto is_blank = [](int c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  int c = 0;
  for (std::uint64_t n = 0; n < count && c >= 0; ++n) {
    c = take();
    while (is_blank(c)) c = take();
    while (c >= 0 && !is_blank(c)) c = take();
  }
  // A line end behind the last one is the next reader's.
  if (c == '\n') --position_;
}

// Skips strings. In text each is a line. In binary the length of each stands before it, in 1, 2, 4 or 8 bytes as two
// bits of the first one say.
void LegacyFile::skip_strings(std::uint64_t count) {
  std::string line;
  for (std::uint64_t n = 0; n < count; ++n) {
    if (is_text_) {
      if (!next_line(line)) return;
      continue;
    }
    constexpr std::uint64_t kLengthBits = 0x3f;
    const int c = take();
    if (c < 0) return;
    const auto first = static_cast<std::uint64_t>(c);
    std::uint64_t length = first & kLengthBits;
    for (int more = (1 << (3 - (first >> 6))) - 1; more > 0; --more) {
      length = length << 8 | static_cast<std::uint64_t>(take() & 0xff);
    }
    position_ += std::min(length, file_->size() - std::min(position_, file_->size()));
  }
}

void LegacyFile::skip(const LegacyArray& array) {
  position_ = array.at;
  if (array.type == "String") return skip_strings(array.numbers());
  if (is_text_) return skip_words(array.numbers());
  constexpr std::uint64_t kBits = 8;
  const std::uint64_t bytes = (array.numbers() * bits_of(array.type) + kBits - 1) / kBits;
  const std::uint64_t left = file_->size() - std::min(array.at, file_->size());
  if (bytes > left) {
    bad_input(path(), std::to_string(bytes) + " bytes of the array " + in_quotes(array.name), std::to_string(left));
  }
  position_ += bytes;
}

// Up to an empty line.
void LegacyFile::skip_metadata() {
  std::string line;
  while (next_line(line) && !trimmed(line).empty()) {
  }
}

// Takes an array. The bytes behind it are looked at only when they are asked for, as nobody may need them.
void LegacyFile::take_array(LegacyArray array) {
  if (section_ != nullptr) section_->all.push_back(array);
  pending_ = std::move(array);
}

// "name type [components]", or for colours "name components"; then the name of a look-up table.
void LegacyFile::take_scalars(const std::vector<std::string>& words) {
  if (words.size() < 3) bad_input(path(), "a name and a type behind " + in_quotes(words[0]), "less");
  const bool colours = legacy_key(words) == "COLOR_SCALARS";
  if (!colours && is_next("LOOKUP_TABLE")) next_words();
  const std::uint64_t components = colours ? count_of(words, 2) : words.size() > 3 ? count_of(words, 3) : 1;
  LegacyArray array = array_here(words[1], colours ? "unsigned_char" : words[2], components, section_->tuples);
  array.is_colours = colours;
  array.is_scalars = true;
  take_array(std::move(array));
}

// "name type", with a dimension between them for coordinates of textures. False for other words.
bool LegacyFile::take_attribute(const std::vector<std::string>& words) {
  static constexpr std::array<std::pair<std::string_view, std::uint64_t>, 8> kComponents{{{"VECTORS", 3},
                                                                                          {"NORMALS", 3},
                                                                                          {"TENSORS", 9},
                                                                                          {"TENSORS6", 6},
                                                                                          {"TEXTURE_COORDINATES", 0},
                                                                                          {"GLOBAL_IDS", 1},
                                                                                          {"PEDIGREE_IDS", 1},
                                                                                          {"EDGE_FLAGS", 1}}};
  const std::string key = legacy_key(words);
  for (const auto& [known, components] : kComponents) {
    if (key != known) continue;
    const std::size_t type = components == 0 ? 3 : 2;
    if (words.size() <= type) bad_input(path(), "a name and a type behind " + in_quotes(words[0]), "less");
    LegacyArray array =
        array_here(words[1], words[type], components == 0 ? count_of(words, 2) : components, section_->tuples);
    array.is_normals = key == "NORMALS";
    take_array(std::move(array));
    return true;
  }
  return false;
}

void LegacyFile::take_field(std::uint64_t arrays) {
  for (std::uint64_t n = 0; n < arrays; ++n) {
    std::vector<std::string> words = next_words();
    while (legacy_key(words) == "METADATA") {
      skip_metadata();
      words = next_words();
    }
    if (words.size() != 4) bad_input(path(), "name, components, tuples and type of an array", "another line");
    const std::uint64_t components = count_of(words, 1);
    if (components > 0) take_array(array_here(words[0], words[3], components, count_of(words, 2)));
  }
}

bool LegacyFile::take_arrays(const std::vector<std::string>& words) {
  const std::string key = legacy_key(words);
  if (key == "METADATA") {
    skip_metadata();
  } else if (key == "POINT_DATA" || key == "CELL_DATA") {
    section_ = key == "POINT_DATA" ? &points : &cells;
    section_->tuples = count_of(words, 1);
  } else if (key == "FIELD") {
    take_field(count_of(words, 2));
  } else if (section_ == nullptr) {
    return false;
  } else if (key == "SCALARS" || key == "COLOR_SCALARS") {
    take_scalars(words);
  } else if (key == "LOOKUP_TABLE") {
    pending_ = array_here(key, "unsigned_char", 4, count_of(words, 2));
  } else {
    return take_attribute(words);
  }
  return true;
}

}  // namespace isoweave
