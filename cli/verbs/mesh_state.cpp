#include "verbs/mesh_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "isoweave/checkpoint_folder.hpp"
#include "isoweave/error.hpp"
#include "isoweave/remote.hpp"
#include "options/input_volume.hpp"
#include "options/values.hpp"

namespace isoweave::cli {
namespace {

// Empty where the path is; a URL as it is.
std::string absolute_path(const std::string& path) {
  return path.empty() || is_url(path) ? path : std::filesystem::absolute(path).string();
}

}  // namespace

void set_task(MeshArguments& arguments, const MeshArguments& now, const Json& task) {
  arguments.input = {task.at("volume"),       task.at("raw"),         task.at("spacing"), task.at("origin"),
                     task.at("series"),       task.at("dataset"),     task.at("level"),   task.at("channel"),
                     task.at("time"),         task.at("slices_from"), task.at("roi"),     task.at("step"),
                     task.at("even_spacing"), task.at("external"),    task.at("unit")};
  arguments.output = {task.at("output"), "", task.at("compress"), task.at("segment"), task.at("one_file"), {}};
  if (now.run.report.empty()) arguments.run.report = task.at("report");
  if (!now.page.given()) arguments.page = {task.at("html"), task.at("page_triangles")};
  arguments.iso = task.at("iso");
  arguments.stop = {task.at("error"),  task.at("triangles"), task.at("ratio"),
                    task.at("specks"), task.at("lods"),      task.at("max_distance")};
  arguments.components = {task.at("min_component"), task.at("largest")};
  arguments.quality = task.at("quality");
  if (now.slab.empty()) arguments.slab = task.at("slab");
  arguments.inside = task.at("inside");
  arguments.smooth = task.at("smooth");
  arguments.extractor = task.at("extractor");
  arguments.normals = task.at("normals");
  arguments.color_by = task.at("color_by");
  arguments.space = task.at("space");
  arguments.open = task.at("open");
  if (now.memory.empty()) arguments.memory = task.at("memory");
  if (now.every.empty()) arguments.every = task.at("every");
}

Json task_json(const MeshArguments& arguments, const MeshOptions& options) {
  return {{"volume", generated_input(arguments.input) ? arguments.input.path : absolute_path(arguments.input.path)},
          {"raw", arguments.input.raw},
          {"spacing", arguments.input.spacing},
          {"origin", arguments.input.origin},
          {"series", arguments.input.series},
          {"dataset", arguments.input.dataset},
          {"level", arguments.input.level},
          {"channel", arguments.input.channel},
          {"time", arguments.input.time},
          {"slices_from", arguments.input.slices_from},
          {"roi", arguments.input.roi},
          {"step", arguments.input.step},
          {"even_spacing", arguments.input.even_spacing},
          {"external", arguments.input.external},
          {"unit", arguments.input.unit},
          {"output", absolute_path(arguments.output.path)},
          {"compress", arguments.output.compress},
          {"one_file", arguments.output.one_file},
          {"segment", arguments.output.segment},
          {"report", absolute_path(arguments.run.report)},
          {"html", arguments.page.given() ? absolute_path(arguments.page.path) : ""},
          {"page_triangles", arguments.page.triangles},
          {"iso", fmt::format("{}", options.iso)},
          {"error", arguments.stop.error},
          {"triangles", arguments.stop.triangles},
          {"ratio", arguments.stop.ratio},
          {"specks", arguments.stop.specks},
          {"min_component", arguments.components.min_component},
          {"largest", arguments.components.largest},
          {"lods", arguments.stop.lods},
          {"max_distance", arguments.stop.max_distance},
          {"quality", arguments.quality},
          {"slab", arguments.slab},
          {"inside", arguments.inside},
          {"smooth", arguments.smooth},
          {"extractor", arguments.extractor},
          {"normals", arguments.normals},
          {"color_by", absolute_path(arguments.color_by)},
          {"space", arguments.space},
          {"open", arguments.open},
          {"memory", arguments.memory},
          {"every", arguments.every}};
}

void refuse_state(const Checkpoint& checkpoint) {
  throw BadInput(checkpoint.path + ": expected a state saved by this isoweave mesh, found another");
}

MeshArguments resumed_arguments(const MeshArguments& now, const Checkpoint& checkpoint) {
  MeshArguments arguments = now;
  try {
    set_task(arguments, now, Json::parse(checkpoint.note));
  } catch (const Json::exception&) {
    refuse_state(checkpoint);
  }
  arguments.checkpoint = now.resume;
  return arguments;
}

void parse_every(std::string_view text, CheckpointOptions& checkpoint) {
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{{{"s", 1}, {"min", 60}, {"h", 3600}}};
  const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::string_view number = text.substr(0, digits);
  const std::string_view unit = text.substr(digits);
  if (unit == "layers") checkpoint.layers = parse_count("--every", number, "16layers");
  for (const auto& [name, seconds] : kUnits) {
    if (unit == name) checkpoint.seconds = seconds * parse_number("--every", number);
  }
  const bool known = unit == "layers" || std::ranges::any_of(kUnits, [&](const auto& u) { return u.first == unit; });
  if (!known || !(checkpoint.seconds > 0)) {
    wrong_value("--every", "a number of layers or a time such as 16layers, 90s, 5min or 2h", text);
  }
}

std::shared_ptr<const CheckpointLock> begin_checkpoints(const std::string& folder) {
  std::shared_ptr<const CheckpointLock> lock = lock_checkpoint_folder(folder);
  if (holds_state(folder)) {
    throw CannotWrite(
        fmt::format("{}: holds an unfinished run: go on with isoweave mesh --resume {}, or remove it", folder, folder));
  }
  return lock;
}

}  // namespace isoweave::cli
