#include "help/option_table.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace isoweave::cli {
namespace {

constexpr const char* kInput = "Input";
constexpr const char* kSurface = "Surface";
constexpr const char* kSimplification = "Simplification";
constexpr const char* kOutput = "Output";
constexpr const char* kPicture = "Picture";
constexpr const char* kLabels = "Labels";
constexpr const char* kMeasures = "Measures";
constexpr const char* kEvidence = "Evidence";
constexpr const char* kResources = "Resources";
constexpr const char* kOther = "Other";

struct Entry {
  std::string_view name;   // longest, without dashes; behind the name of a verb where that has another meaning of it
  const char* value = "";  // what its value is; empty for a flag
  const char* group = kOther;
};

constexpr std::array kEntries{
    Entry{"VOLUME", "", kInput},
    Entry{"raw", "LAYOUT", kInput},
    Entry{"spacing", "X,Y,Z", kInput},
    Entry{"origin", "X,Y,Z", kInput},
    Entry{"unit", "UNIT", kInput},
    Entry{"series", "UID", kInput},
    Entry{"even-spacing", "HOW", kInput},
    Entry{"dataset", "NAME", kInput},
    Entry{"level", "N", kInput},
    Entry{"channel", "N", kInput},
    Entry{"time", "N", kInput},
    Entry{"slices-from", "AXIS", kInput},
    Entry{"roi", "RANGES", kInput},
    Entry{"step", "N", kInput},
    Entry{"weld", "", kInput},
    Entry{"no-external", "", kInput},
    Entry{"index", "FILE", kInput},
    Entry{"iso", "VALUE", kSurface},
    Entry{"extractor", "KIND", kSurface},
    Entry{"inside", "SIDE", kSurface},
    Entry{"open", "", kSurface},
    Entry{"closed", "", kSurface},
    Entry{"smooth", "", kSurface},
    Entry{"largest", "", kSurface},
    Entry{"min-component", "N", kSurface},
    Entry{"error", "LENGTH", kSimplification},
    Entry{"triangles", "N", kSimplification},
    Entry{"ratio", "R", kSimplification},
    Entry{"lods", "LENGTHS", kSimplification},
    Entry{"max-distance", "LENGTH", kSimplification},
    Entry{"quality", "HOW", kSimplification},
    Entry{"specks", "HOW", kSimplification},
    Entry{"preview", "", kSimplification},
    Entry{"output", "FILE", kOutput},
    Entry{"to-stdout", "FORMAT", kOutput},
    Entry{"no-clobber", "", kOutput},
    Entry{"allow-empty", "", kOutput},
    Entry{"space", "NAME", kOutput},
    Entry{"output-unit", "UNIT", kOutput},
    Entry{"scale", "S", kOutput},
    Entry{"center", "", kOutput},
    Entry{"ground", "", kOutput},
    Entry{"normals", "KIND", kOutput},
    Entry{"compress", "", kOutput},
    Entry{"one-file", "", kOutput},
    Entry{"segment", "N", kOutput},
    Entry{"type", "TYPE", kOutput},
    Entry{"seed", "N", kOutput},
    Entry{"size", "SIZE", kOutput},
    Entry{"view", "VIEW", kPicture},
    Entry{"up", "AXIS", kPicture},
    Entry{"zoom", "FACTOR", kPicture},
    Entry{"axes", "", kPicture},
    Entry{"background", "COLOR", kPicture},
    Entry{"color", "COLOR", kPicture},
    Entry{"color-by", "WHAT", kOutput},
    Entry{"range", "LOW,HIGH", kPicture},
    Entry{"no-color-bar", "", kPicture},
    Entry{"shading", "KIND", kPicture},
    Entry{"wireframe", "", kPicture},
    Entry{"samples", "N", kMeasures},
    Entry{"voxel", "LENGTH", kMeasures},
    Entry{"histogram", "N", kMeasures},
    Entry{"distances", "FILE", kMeasures},
    Entry{"self-intersections", "", kMeasures},
    Entry{"labels", "LIST", kLabels},
    Entry{"label-names", "FILE", kLabels},
    Entry{"min-label", "N", kLabels},
    Entry{"report", "FILE", kEvidence},
    Entry{"html", "FILE", kEvidence},
    Entry{"page-triangles", "N", kEvidence},
    Entry{"before", "MESH", kEvidence},
    Entry{"view open", "", kOther},
    Entry{"watch", "", kEvidence},
    Entry{"dry-run", "", kEvidence},
    Entry{"isos", "", kEvidence},
    Entry{"json", "", kEvidence},
    Entry{"threads", "N", kResources},
    Entry{"memory", "SIZE", kResources},
    Entry{"slab", "N", kResources},
    Entry{"blocks", "N", kResources},
    Entry{"device", "NAME", kResources},
    Entry{"schedule", "NAME", kResources},
    Entry{"checkpoint", "FOLDER", kResources},
    Entry{"every", "INTERVAL", kResources},
    Entry{"resume", "FOLDER", kResources},
    Entry{"progress", "WHEN", kOther},
    Entry{"quiet", "", kOther},
    Entry{"help", "", kOther},
};

std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : option.get_lnames().back();
}

}  // namespace

void describe_options(CLI::App& verb) {
  for (CLI::Option* option : verb.get_options()) {
    const std::string name = name_of(*option);
    const auto* entry = std::ranges::find(kEntries, verb.get_name() + " " + name, &Entry::name);
    if (entry == kEntries.end()) entry = std::ranges::find(kEntries, std::string_view(name), &Entry::name);
    if (option->get_positional()) continue;
    option->group(entry != kEntries.end() ? entry->group : kOther);
    if (entry != kEntries.end() && *entry->value != '\0') option->type_name(entry->value);
  }
}

const std::vector<std::string>& option_groups() {
  static const std::vector<std::string> kGroups{kInput,  kSurface,  kSimplification, kOutput,    kPicture,
                                                kLabels, kMeasures, kEvidence,       kResources, kOther};
  return kGroups;
}

std::string usage_text(const std::string& verb) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kUsages{
      {{"mesh", "VOLUME [-o MESH] --iso VALUE [options]"},
       {"simplify", "MESH [-o MESH] --error LENGTH [options]"},
       {"info", "VOLUME [options]"},
       {"check", "MESH [options]"},
       {"compare", "A B [options]"},
       {"render", "MESH [-o PICTURE] [options]"},
       {"view", "MESH|REPORT [options]"},
       {"generate", "KIND -o VOLUME --size SIZE [options]"},
       {"index", "VOLUME [-o FILE] [options]"},
       {"plan", "VOLUME --iso VALUE -o FOLDER [options]"},
       {"work", "FOLDER [options]"},
       {"status", "FOLDER [--json]"},
       {"collect", "FOLDER -o MESH [options]"}}};
  for (const auto& [name, usage] : kUsages) {
    if (name == verb) return std::string(usage);
  }
  return "[options]";
}

}  // namespace isoweave::cli
