#include "volume/formats/medical/segmentation.hpp"

#include <optional>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "isoweave/label_names.hpp"

namespace isoweave {
namespace {

using Fields = std::map<std::string, std::string>;

// "Segment12_Name" belongs to segment 12.
std::optional<std::int64_t> number_of(std::string_view key) {
  constexpr std::string_view kBegin = "Segment";
  if (!key.starts_with(kBegin)) return std::nullopt;
  key.remove_prefix(kBegin.size());
  const auto number = parse_integer(key.substr(0, key.find('_')));
  const bool is_one = number && *number >= 0 && key.find('_') != std::string_view::npos;
  return is_one ? number : std::nullopt;
}

std::map<std::int64_t, Fields> grouped(const std::map<std::string, std::string>& pairs) {
  std::map<std::int64_t, Fields> segments;
  for (const auto& [key, value] : pairs) {
    if (const auto number = number_of(key)) segments[*number].emplace(key.substr(key.find('_') + 1), value);
  }
  return segments;
}

// Undoes the escapes of NRRD: "
// " and "\\".
std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool escape = text[n] == '\\' && n + 1 < text.size() && (text[n + 1] == 'n' || text[n + 1] == '\\');
    result += !escape ? text[n] : text[++n] == 'n' ? '\n' : '\\';
  }
  return result;
}

std::optional<std::array<double, 3>> color_of(std::string_view text) {
  const std::vector<std::string_view> words = words_of(text);
  std::array<double, 3> color{};
  if (words.size() != color.size()) return std::nullopt;
  for (std::size_t n = 0; n < color.size(); ++n) {
    const auto part = parse_double(words[n]);
    if (!part || !(*part >= 0 && *part <= 1)) return std::nullopt;
    color[n] = *part;
  }
  return color;
}

class SegmentReader {
 public:
  SegmentReader(std::int64_t layers, std::string_view path) : layers_(layers), path_(path) {}

  LabelName read(std::int64_t number, const Fields& fields) const {
    const auto field = [&](const char* name) {
      const auto found = fields.find(name);
      return found == fields.end() ? std::string_view() : trimmed(found->second);
    };
    const std::string segment = "Segment" + std::to_string(number) + "_";
    LabelName entry;
    entry.name = unescaped(field("Name"));
    entry.color = color_of(field("Color"));
    entry.label = label_of(field("LabelValue"), segment + "LabelValue");
    entry.layer = layer_of(field("Layer"), number, segment + "Layer");
    return entry;
  }

 private:
  Label label_of(std::string_view text, const std::string& what) const {
    if (text.empty()) return 1;
    const std::optional<Label> label = parse_label(text);
    if (!label) bad_input(path_, "a whole number as " + what, in_quotes(text));
    return *label;
  }

  std::int64_t layer_of(std::string_view text, std::int64_t number, const std::string& what) const {
    if (text.empty() && layers_ == 1) return 0;
    const std::optional<std::int64_t> layer = text.empty() ? number : parse_integer(text);
    if (!layer || *layer < 0 || *layer >= layers_) {
      bad_input(path_, what + " from 0 to " + std::to_string(layers_ - 1),
                text.empty() ? "segment " + std::to_string(number) : in_quotes(text));
    }
    return *layer;
  }

  std::int64_t layers_;
  std::string_view path_;
};

}  // namespace

std::vector<LabelName> segments_of(const std::map<std::string, std::string>& pairs, std::int64_t layers,
                                   std::string_view path) {
  const SegmentReader reader(layers, path);
  std::vector<LabelName> segments;
  for (const auto& [number, fields] : grouped(pairs)) segments.push_back(reader.read(number, fields));
  return segments;
}

}  // namespace isoweave
