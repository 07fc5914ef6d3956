// 3MF: all items that are to be built, each object at its place, as one mesh. Objects may be made of others, and may
// lie in other parts of the package.
#include <algorithm>
#include <set>

#include "files/xml_tag.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/model_3mf.hpp"
#include "mesh/read/placement.hpp"
#include "mesh/read/zip_input.hpp"

namespace isoweave::mesh_io {
namespace {

// Names of parts are the same in capitals. Some programs write them with backslashes.
std::string part_name(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  std::string lower(name);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '\\') c = '/';
  }
  return lower;
}

struct UnitOf3mf {
  std::string_view name, unit;  // ours
  double factor = 1;            // from the one to the other
};

constexpr std::array<UnitOf3mf, 6> kUnits{{{"micron", "um", 1},
                                           {"millimeter", "mm", 1},
                                           {"centimeter", "mm", 10},
                                           {"inch", "in", 1},
                                           {"foot", "in", 12},
                                           {"meter", "m", 1}}};

class PackageReader {
 public:
  explicit PackageReader(MeshInput& input) : input_(input), records_(read_zip_directory(input)), mesh_(input) {}

  TriangleMesh read() {
    root_ = find_root();
    const Model& model = part(root_);
    place_.take_comment(model.application == "isoweave" ? model.description : "");
    const Placement unit = unit_of(model);
    std::vector<PlacedObject> items = model.items;
    if (items.empty()) items = all_objects(model);
    for (const PlacedObject& item : items) add(root_, item, unit, 0);
    if (placed_.empty() && skipped_ > 0) input_.fail("expected objects that are models, found none to build");
    join();
    put_notes();
    return mesh_.finish(place_);
  }

 private:
  struct PlacedPart {
    ModelObject* object = nullptr;
    Placement placement;
  };

  const ZipRecord* find_record(const std::string& name) const {
    for (const ZipRecord& record : records_) {
      if (part_name(record.name) == name) return &record;
    }
    return nullptr;
  }

  // The part that the package begins with: the one that its relationships name or, where they name none, the first
  // model.
  std::string find_root() {
    if (const ZipRecord* relations = find_record("_rels/.rels")) {
      std::string named = related_model(*relations);
      if (!named.empty()) return named;
    }
    for (const ZipRecord& record : records_) {
      std::string name = part_name(record.name);
      if (name.ends_with(".model")) return name;
    }
    input_.fail("expected an entry '*.model' in the archive, found none");
  }

  std::string related_model(const ZipRecord& record) {
    constexpr std::size_t kLongest = std::size_t{1} << 16;
    std::string text;
    ZipText relations(input_, record);
    for (int c = relations.get(); c >= 0 && text.size() < kLongest; c = relations.get()) {
      text.push_back(static_cast<char>(c));
    }
    for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at + 1)) {
      const std::string_view tag = std::string_view(text).substr(at + 1, text.find('>', at) - at - 1);
      if (xml_attribute(tag, "Type").ends_with("/3dmodel")) return part_name(xml_attribute(tag, "Target"));
    }
    return {};
  }

  Model& part(const std::string& name) {
    const auto found = parts_.find(name);
    if (found != parts_.end()) return found->second;
    const ZipRecord* const record = find_record(name);
    if (record == nullptr) input_.fail("expected an entry '" + name + "' in the archive, found none");
    return parts_.emplace(name, read_model(input_, *record)).first->second;
  }

  // The map from the model's unit to ours. Files of isoweave say theirs themselves, as 3MF has no nanometres (which are
  // a thousandth of a micron there) and no unknown unit.
  Placement unit_of(const Model& model) {
    const auto* const found =
        std::find_if(kUnits.begin(), kUnits.end(), [&](const UnitOf3mf& unit) { return unit.name == model.unit; });
    if (found == kUnits.end()) input_.fail("expected a unit of 3MF, found '" + model.unit.substr(0, 40) + "'");
    const bool ours = model.application == "isoweave";
    double factor = found->factor;
    if (ours && model.description.find("UNIT=nm") != std::string::npos && model.unit == "micron") factor = 1000;
    if (!ours) place_.take("UNIT", found->unit);
    if (!ours && factor != 1)
      mesh_.mesh().notes.push_back("is in units of " + model.unit + ", read as " + std::string(found->unit));
    Placement placement;
    for (const std::size_t n : {0U, 4U, 8U}) placement.linear.at(n) = factor;
    return placement;
  }

  // The objects that are no part of another one.
  std::vector<PlacedObject> all_objects(const Model& model) {
    std::set<std::uint32_t> used;
    for (const auto& [id, object] : model.objects) {
      for (const PlacedObject& component : object.components) {
        if (component.part.empty()) used.insert(component.id);
      }
    }
    std::vector<PlacedObject> all;
    for (const auto& [id, object] : model.objects) {
      if (!used.contains(id)) all.push_back({"", id, {}});
    }
    if (!all.empty()) mesh_.mesh().notes.emplace_back("says nothing of what to build: all objects are read");
    return all;
  }

  // Finds the meshes that an object is made of.
  void add(const std::string& from, const PlacedObject& placed, const Placement& outer, int depth) {
    constexpr int kDeepest = 64;
    constexpr std::size_t kMostVisits = 1 << 20;
    if (depth == kDeepest || ++visits_ > kMostVisits) {
      input_.fail("expected objects within objects up to 64 deep and a million in all, found more");
    }
    const std::string name = placed.part.empty() ? from : part_name(placed.part);
    Model& model = part(name);
    if (model.unit != part(root_).unit) input_.fail("expected one unit in all models, found several");
    const auto found = model.objects.find(placed.id);
    if (found == model.objects.end()) input_.fail("expected an object " + std::to_string(placed.id) + ", found none");
    ModelObject& object = found->second;
    if (object.type == "support" || object.type == "other") {
      leftovers_.left_out(1, "objects of type " + object.type);
      ++skipped_;
      return;
    }
    const Placement placement = both(placed.placement, outer);
    if (!placement.is_regular()) input_.fail("expected transforms that can be undone, found others");
    for (const PlacedObject& component : object.components) add(name, component, placement, depth + 1);
    if (!object.vertices.empty()) placed_.push_back({&object, placement});
  }

  // A file of a few bytes can name one mesh any number of times.
  void check_counts() const {
    std::uint64_t copied = 0;
    std::set<const ModelObject*> seen;
    for (const PlacedPart& placed : placed_) {
      if (!seen.insert(placed.object).second)
        copied += placed.object->vertices.size() + placed.object->triangles.size();
    }
    if (copied > kMostCopies * input_.size()) {
      input_.fail("expected copies of objects in proportion to the file, found " + std::to_string(copied) +
                  " vertices and triangles in them");
    }
  }

  void join() {
    check_counts();
    std::map<const ModelObject*, std::uint64_t> left;
    for (const PlacedPart& placed : placed_) ++left[placed.object];
    for (const PlacedPart& placed : placed_) {
      ModelObject& object = *placed.object;
      const std::uint64_t count = object.vertices.size();
      const bool last = --left[&object] == 0;
      const std::uint32_t first =
          mesh_.add_vertices(last ? std::move(object.vertices) : object.vertices, placed.placement);
      mesh_.add_triangles(object.triangles, first, count, placed.placement.determinant() < 0);
      if (last) object.triangles = {};
    }
  }

  void put_notes() {
    std::vector<std::string>& notes = mesh_.mesh().notes;
    if (placed_.size() > 1) notes.push_back(std::to_string(placed_.size()) + " objects are joined");
    const bool materials =
        std::any_of(parts_.begin(), parts_.end(), [](const auto& p) { return p.second.has_materials; });
    if (materials) leftovers_.not_kept("colours and materials");
    leftovers_.note(mesh_.mesh());
  }

  MeshInput& input_;
  std::vector<ZipRecord> records_;
  std::string root_;
  std::map<std::string, Model> parts_;
  std::vector<PlacedPart> placed_;
  MeshLeftovers leftovers_;
  std::size_t visits_ = 0, skipped_ = 0;
  MeshPlace place_;
  PlacedMesh mesh_;
};

}  // namespace

TriangleMesh read_3mf(MeshInput& input) { return PackageReader(input).read(); }

}  // namespace isoweave::mesh_io
