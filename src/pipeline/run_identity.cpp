#include "pipeline/run_identity.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "files/crc32.hpp"
#include "isoweave/error.hpp"
#include "system/file_facts.hpp"

namespace isoweave {
namespace {

// Numbers as text. No stream is used: a process that has made none yet would pay a third of a millisecond, once a run.
std::string numbers_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.begin(), digits.end(), number, std::chars_format::general, 17);
    text += ' ';
    text.append(digits.begin(), end.ptr);
  }
  return text;
}

// The size and time of change of a file. Empty for what is no file of this machine.
std::string change_text(const std::string& path) {
  const std::optional<system::FileFacts> facts = system::facts_of_file(path);
  if (!facts) return {};
  return ", " + std::to_string(facts->bytes) + " bytes changed at " + std::to_string(facts->seconds) + "." +
         std::to_string(facts->nanoseconds);
}

// The same of the files that hold the samples of a header. A series has thousands of them, so many become a checksum.
std::string samples_text(const std::vector<std::string>& files) {
  if (files.empty()) return {};
  if (files.size() == 1) return ", samples" + change_text(files.front());
  std::uint32_t crc = 0;
  for (const std::string& file : files) {
    const std::string text = change_text(file);
    crc = add_to_crc(crc, std::as_bytes(std::span(text)));
  }
  return ", samples in " + std::to_string(files.size()) + " files whose sizes and times of change have the checksum " +
         std::to_string(crc);
}

// The chosen part of the file that was opened, and the size and time of change of that file, or of the file that
// describes a folder, and of those that hold the samples.
std::string file_text(const VolumeInfo& volume) {
  const std::string& path = volume.header.empty() ? volume.path : volume.header;
  const std::string part = volume.part.empty() ? "" : ", " + volume.part;
  return part + change_text(path) + samples_text(volume.data_files);
}

// A task as text. Its fields are taken apart by name, so a new field of a task does not compile before it is told here.
std::string simplify_text(const SimplifyTask& task) {
  [[maybe_unused]] const auto& [side, unit, error, level_errors, goal, needed, zone, level_costs, normals, values] =
      task;
  [[maybe_unused]] const auto& [numbering, a0, retire, drop_specks, most_distance, cell, largest, normals_count,
                                quality] = zone;
  std::string text = ", error" + numbers_text(std::array{error}) + ", triangles " + std::to_string(goal.triangles);
  if (goal.share > 0) text += ", share" + numbers_text(std::array{goal.share});
  for (const double level : level_errors) text += ", level" + numbers_text(std::array{level});
  text += ", quality " + std::to_string(static_cast<int>(quality));
  if (drop_specks) text += ", no specks";
  if (most_distance > 0) text += ", distance" + numbers_text(std::array{most_distance});
  return text;
}

std::string level_set_text(const SurfaceOptions& surface) {
  constexpr std::array<const char*, 4> kExtractors{"", " trilinear", " tetrahedra", " dual"};
  std::string text = "iso" + numbers_text(std::array{surface.iso}) + (surface.inside_above ? " above" : " below") +
                     (surface.closed ? " closed" : " open") +
                     kExtractors.at(static_cast<std::size_t>(surface.extractor));
  // Smoothing changes the connections of a trilinear surface only.
  const bool smooth_counts = surface.smooth > 0 && surface.extractor == ExtractorKind::kTrilinear;
  return smooth_counts ? text + " smooth " + std::to_string(surface.smooth) : text;
}

std::string surface_text(const SurfaceOptions& surface) {
  [[maybe_unused]] const auto& [iso, inside_above, closed, smooth, extractor, components] = surface;
  std::string text = level_set_text(surface);
  if (smooth > 0) text += ", smooth " + std::to_string(smooth);
  if (components == nullptr) return text;
  const auto& [min_triangles, largest] = components->rule;
  return text + ", components of " + std::to_string(min_triangles) + (largest ? ", the largest" : "");
}

std::string attributes_text(const AttributeOptions& attributes) {
  const auto& [normals, values] = attributes;
  constexpr std::array<const char*, 3> kNormals{"", ", normals", ", normals by quadrics"};
  return std::string(kNormals.at(static_cast<std::size_t>(normals))) + (values != nullptr ? ", values" : "");
}

std::string input_text(const Task& task) {
  const SliceSource* const values = task.attributes.values.get();
  return volume_text(task.volume) + (values != nullptr ? ", values" + file_text(values->info()) : "");
}

}  // namespace

std::string volume_text(const VolumeInfo& volume) {
  const auto& [nx, ny, nz] = volume.dims;
  const Geometry& geometry = volume.geometry;
  return std::to_string(nx) + " x " + std::to_string(ny) + " x " + std::to_string(nz) + ' ' +
         std::string(sample_type_name(volume.type)) + ", spacing" + numbers_text(geometry.spacing) + ", origin" +
         numbers_text(geometry.origin) + ", axes" + numbers_text(geometry.direction) + ", scale" +
         numbers_text(std::array{volume.slope, volume.intercept}) + file_text(volume);
}

std::string surface_text(const VolumeInfo& volume, const SurfaceOptions& surface) {
  return volume_text(volume) + ", " + level_set_text(surface);
}

RunIdentity identity_of(const Task& task) {
  [[maybe_unused]] const auto& [volume, surface, attributes, space, offset, rule, simplify, measured] = task;
  RunIdentity identity{input_text(task), surface_text(surface) + simplify_text(simplify) + attributes_text(attributes)};
  identity.options += ", space " + std::to_string(static_cast<int>(space));
  if (!measured) identity.options += ", not measured";
  if (offset != std::array<double, 3>{0, 0, 0}) identity.options += ", offset" + numbers_text(offset);
  return identity;
}

void require_unchanged(const Task& task, const RunIdentity& before) {
  if (input_text(task) == before.volume) return;
  throw BadInput(task.volume.path + ": expected a file that stays as it is while it is read, found it changed");
}

}  // namespace isoweave
