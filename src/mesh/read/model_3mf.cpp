#include "mesh/read/model_3mf.hpp"

#include <utility>

#include "files/xml_tag.hpp"

namespace isoweave::mesh_io {
namespace {

constexpr std::size_t kLongestTag = std::size_t{1} << 16;
constexpr std::size_t kLongestText = 4096;
constexpr std::string_view kBlanks = " \t\r\n";

// Prefixes that a tag declares, by the names of their namespaces; the empty prefix is the one that need not be written.
std::map<std::string, std::string> prefixes_of(std::string_view tag) {
  constexpr std::string_view kDeclaration = "xmlns";
  std::map<std::string, std::string> prefixes;
  for (std::size_t at = tag.find(kDeclaration); at < tag.size(); at = tag.find(kDeclaration, at + 1)) {
    const std::size_t end = std::min(tag.find('=', at), tag.size());
    std::string_view name = tag.substr(at, end - at);
    name = name.substr(0, name.find_first_of(kBlanks));
    const std::string uri = xml_attribute(tag, name);
    if (name.size() > kDeclaration.size() && name[kDeclaration.size()] != ':') continue;
    if (!uri.empty()) prefixes[uri] = name.substr(std::min(name.size(), kDeclaration.size() + 1));
  }
  return prefixes;
}

// Colours and the like, parts of models, and names for sets of triangles leave the shape as it is.
bool keeps_shape(std::string_view uri) {
  for (const std::string_view known : {"/core/", "/material/", "/production/", "/trianglesets/"}) {
    if (uri.find("/3dmanufacturing" + std::string(known)) != std::string_view::npos) return true;
  }
  return false;
}

class ModelReader {
 public:
  ModelReader(MeshInput& input, const ZipRecord& record) : input_(input), text_(input, record) {}

  Model read() {
    while (next_tag()) take_tag();
    if (!complete_) input_.fail("expected a model and its end, found none");
    return std::move(model_);
  }

 private:
  // Finds the next tag, and the text before it. Returns false at the end.
  bool next_tag() {
    before_.clear();
    for (int c = text_.get(); c != '<'; c = text_.get()) {
      if (c < 0) return false;
      if (!begun_ && (c == 0 || c >= 0xfe)) input_.fail("expected a model in UTF-8, found another encoding");
      if (before_.size() < kLongestText) before_.push_back(static_cast<char>(c));
    }
    tag_.clear();
    int quote = 0;
    for (int c = text_.get(); c >= 0; c = text_.get()) {
      if (c == '>' && quote == 0 && is_whole()) return true;
      if (tag_.size() == kLongestTag) input_.fail("a tag of the model is longer than 65536 bytes");
      tag_.push_back(static_cast<char>(c));
      if (tag_[0] == '!' || (c != '"' && c != '\'')) continue;
      if (quote == 0 || quote == c) quote = quote == 0 ? c : 0;
    }
    return false;
  }

  // Whether a tag is whole. A comment ends with "--", and a section of plain text with "]]".
  bool is_whole() const {
    constexpr std::size_t kShortest = 5;
    if (tag_.starts_with("!--")) return tag_.size() >= kShortest && tag_.ends_with("--");
    return !tag_.starts_with("![CDATA[") || tag_.ends_with("]]");
  }

  void take_tag() {
    std::string_view name = std::string_view(tag_).substr(0, tag_.find_first_of(" \t\r\n/", 1));
    if (name.starts_with('!') || name.starts_with('?')) return;
    const bool ends = name.starts_with('/');
    if (ends) name.remove_prefix(1);
    const std::size_t colon = name.find(':');
    const std::string_view prefix = colon == std::string_view::npos ? "" : name.substr(0, colon);
    if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
    if (!begun_ && name == "model") begin_model();
    if (!begun_) return;
    if (prefix != core_prefix_) {
      model_.has_materials = model_.has_materials || name == "colorgroup" || name == "texture2dgroup";
    } else if (ends) {
      end_element(name);
    } else {
      begin_element(name);
    }
  }

  void begin_element(std::string_view name) {
    if (name == "metadata") metadata_ = xml_attribute(tag_, "name");
    if (name == "object") begin_object();
    if (name == "vertex") take_vertex();
    if (name == "triangle") take_triangle();
    if (name == "component") object().components.push_back(placed_object());
    if (name == "item") model_.items.push_back(placed_object());
    model_.has_materials = model_.has_materials || name == "basematerials";
  }

  void end_element(std::string_view name) {
    if (name == "object") object_ = nullptr;
    if (name == "model") complete_ = true;
    if (name != "metadata") return;
    if (metadata_ == "Application") model_.application = before_;
    if (metadata_ == "Description") model_.description = before_;
  }

  void begin_model() {
    begun_ = true;
    const std::string unit = xml_attribute(tag_, "unit");
    if (!unit.empty()) model_.unit = unit;
    const std::string required = xml_attribute(tag_, "requiredextensions");
    std::string_view words = required;
    std::vector<std::string_view> wanted;
    for (std::string_view word = take_word(words); !word.empty(); word = take_word(words)) wanted.push_back(word);
    for (const auto& [uri, prefix] : prefixes_of(tag_)) {
      if (uri.find("/3dmanufacturing/core/") != std::string::npos) core_prefix_ = prefix;
      if (uri.find("/3dmanufacturing/production/") != std::string::npos) production_prefix_ = prefix;
      for (const std::string_view word : wanted) {
        if (word == prefix && !keeps_shape(uri)) {
          input_.fail("expected a model without further extensions, found one that requires '" + uri + "'");
        }
      }
    }
  }

  void begin_object() {
    const std::uint32_t id = number("id", "an object");
    if (model_.objects.contains(id))
      input_.fail("expected objects of different ids, found two of " + std::to_string(id));
    object_ = &model_.objects[id];
    object_->type = xml_attribute(tag_, "type");
  }

  ModelObject& object() const {
    if (object_ == nullptr) input_.fail("expected vertices, triangles and components in an object, found others");
    return *object_;
  }

  void take_vertex() {
    if (object().vertices.size() == kMostVertices) input_.fail("has more than 4294967295 vertices");
    WidePoint point{};
    constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string text = xml_attribute(tag_, kNames[axis]);
      const std::optional<double> value = parse_wide(text);
      if (!value) input_.fail("expected a finite number in a vertex, found '" + text.substr(0, 40) + "'");
      point[axis] = *value;
    }
    object().vertices.push_back(point);
  }

  void take_triangle() {
    std::array<std::uint32_t, 3> triangle{};
    constexpr std::array<const char*, 3> kNames{"v1", "v2", "v3"};
    for (std::size_t corner = 0; corner < 3; ++corner) triangle[corner] = number(kNames[corner], "a triangle");
    object().triangles.push_back(triangle);
  }

  PlacedObject placed_object() const {
    return {xml_attribute(tag_, production_prefix_ + ":path"), number("objectid", "a component or item"), placement()};
  }

  // Twelve numbers: the images of the axes, and the shift.
  Placement placement() const {
    const std::string text = xml_attribute(tag_, "transform");
    Placement placement;
    if (text.empty()) return placement;
    std::string_view words = text;
    for (std::size_t n = 0; n < 12; ++n) {
      const std::optional<double> value = parse_real<double>(take_word(words));
      if (!value) input_.fail("expected twelve numbers as a transform, found '" + text.substr(0, 100) + "'");
      (n < 9 ? placement.linear.at(n % 3 * 3 + n / 3) : placement.shift.at(n % 3)) = *value;
    }
    if (!take_word(words).empty() || !placement.is_regular()) {
      input_.fail("expected a transform that can be undone, found '" + text.substr(0, 100) + "'");
    }
    return placement;
  }

  std::uint32_t number(const char* name, const char* what) const {
    const std::string text = xml_attribute(tag_, name);
    const std::optional<std::uint32_t> value = parse_integer<std::uint32_t>(text);
    if (!value) {
      input_.fail("expected a number as " + std::string(name) + " of " + what + ", found '" + text.substr(0, 40) + "'");
    }
    return *value;
  }

  MeshInput& input_;
  ZipText text_;
  std::string tag_, before_;
  std::string core_prefix_, production_prefix_ = "p";
  std::string metadata_;  // the name of the one that began last
  ModelObject* object_ = nullptr;
  bool begun_ = false, complete_ = false;
  Model model_;
};

}  // namespace

Model read_model(MeshInput& input, const ZipRecord& record) { return ModelReader(input, record).read(); }

}  // namespace isoweave::mesh_io
