#include "options/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "options/values.hpp"
#include "report/print.hpp"

namespace isoweave::cli {
namespace {

// A colour by hue (turns), saturation and value.
std::array<double, 3> color_of_hue(double hue, double saturation, double value) {
  std::array<double, 3> color{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double sector = std::fmod(hue * 6 + 5 - 2 * static_cast<double>(channel), 6);
    color[channel] = value * (1 - saturation * std::clamp(std::min(sector, 4 - sector), 0.0, 1.0));
  }
  return color;
}

}  // namespace

// Hues go on by the golden section, which keeps any number of them apart; each round of three is darker. The first is
// that of bone.
std::array<double, 3> part_color(std::size_t n) {
  constexpr double kFirst = 0.095, kGolden = 0.6180339887498949;
  constexpr std::array<double, 3> kSaturations{0.45, 0.6, 0.75}, kValues{0.92, 0.78, 0.62};
  const std::size_t round = n / 3 % 3;
  return color_of_hue(std::fmod(kFirst + static_cast<double>(n) * kGolden, 1), kSaturations[round], kValues[round]);
}

std::string color_text(std::span<const double> color) {
  const auto byte = [](double part) { return static_cast<int>(std::lround(255 * part)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color[0]), byte(color[1]), byte(color[2]));
}

std::string SurfaceOutput::name() const {
  return output.one_file ? fmt::format("{}, {}", output.name(), part.name) : output.name();
}

OutputOptions surface_output(const OutputOptions& output, std::string_view word) {
  if (output.one_file) return output;
  const std::filesystem::path path(output.path);
  OutputOptions of_surface = output;
  of_surface.path =
      (path.parent_path() / fmt::format("{}_{}{}", path.stem().string(), word, path.extension().string())).string();
  return of_surface;
}

void check_parts(const OutputOptions& output, bool of_labels) {
  if (!output.one_file) return;
  const MeshFormat format = output_format(output);
  if (format == MeshFormat::kGlb || format == MeshFormat::kVtp) return;
  if (of_labels && format == MeshFormat::kPrecomputed && output.compress) return;
  wrong_value("--one-file",
              of_labels ? "a mesh named .glb or .vtp, or .precomputed with --compress, for several labels"
                        : "a mesh named .glb or .vtp for several iso-values",
              output.path);
}

std::vector<std::unique_ptr<MeshSink>> open_surfaces(std::span<const SurfaceOutput> surfaces) {
  if (surfaces.front().output.one_file) {
    std::vector<MeshPart> parts;
    for (const SurfaceOutput& surface : surfaces) parts.push_back(surface.part);
    return open_mesh_parts(surfaces.front().output.path, parts);
  }
  std::vector<std::unique_ptr<MeshSink>> files;
  for (const SurfaceOutput& surface : surfaces) files.push_back(open_output(surface.output, surface.part.options));
  return files;
}

void tell_digests(std::span<const std::unique_ptr<MeshSink>> files, std::span<MeshReport> surfaces, MeshReport& total) {
  for (std::size_t n = 0; n < files.size(); ++n) {
    const std::uint64_t of_file = file_digest(*files[n], surfaces[n].digest);
    total.digest += of_file - std::exchange(surfaces[n].digest, of_file);
  }
}

}  // namespace isoweave::cli
