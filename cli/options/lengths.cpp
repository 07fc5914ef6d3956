#include "options/lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "isoweave/pipeline.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/report.hpp"

namespace isoweave::cli {
namespace {

constexpr double kLargePart = 0.05;          // of a diagonal: an error above it ruins the shape
constexpr double kSmallPart = 0.001;         // of the sides of a voxel: no scan is that exact
constexpr double kCoordinateStep = 0x1p-24;  // of a mesh's diagonal: coordinates in 32 bits do not tell it apart

// "0.2voxels" as "0.2vox".
std::string short_length(const std::string& text) {
  for (const std::string_view name : {"voxels", "voxel"}) {
    if (text.ends_with(name)) return text.substr(0, text.size() - name.size()) + "vox";
  }
  return text;
}

std::optional<Length> to_length(const std::string& text, const LengthBasis& basis) {
  try {
    const Length length = parse_length(short_length(text), basis.unit, basis.diagonal);
    if (std::isfinite(length.value)) return length;
  } catch (const std::invalid_argument&) {
    // The library does not know which option the text came from.
  }
  return std::nullopt;
}

[[noreturn]] void wrong_length(std::string_view option, std::string_view range, std::string_view text) {
  wrong_value(option, fmt::format("a length {} such as 0.2vox, 0.05mm, 30um, 500nm or 0.1%", range), text);
}

// Whether a length is given in a metric unit, and not in voxels, in percent or without a unit.
bool is_metric_length(const std::string& text) {
  return !text.empty() && text.find_last_not_of("0123456789.%") == text.size() - 1 &&
         text.find("vox") == std::string::npos && text.find_first_of("0123456789") != std::string::npos;
}

// A length in the unit of the input; nothing where none is given, or one in voxels or in percent.
std::optional<double> length_of_unit(std::string_view option, const std::string& text, const LengthBasis& basis) {
  if (text.empty() || text.ends_with('%')) return std::nullopt;
  const Length length = parse_error_length(option, text, basis);
  return length.in_voxels ? std::nullopt : std::optional(length.value);
}

// The reason why a length does not fit the thing; empty where it does.
std::string_view misfit(double length, const LengthBasis& basis) {
  if (basis.diagonal > 0 && length > kLargePart * basis.diagonal) return "more than a twentieth of its diagonal";
  if (length <= 0 || length >= basis.least) return "";
  return basis.is_volume ? "less than a thousandth of its voxels" : "less than coordinates of 32 bits tell apart";
}

}  // namespace

LengthBasis length_basis(const VolumeInfo& volume) {
  const auto& spacing = volume.geometry.spacing;
  LengthBasis basis{volume.geometry.unit, {}, box_diagonal(volume), kSmallPart * std::ranges::min(spacing), true};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    basis.size[axis] = spacing[axis] * static_cast<double>(volume.dims[axis]);
  }
  return basis;
}

LengthBasis length_basis(const TriangleMesh& mesh) {
  const double diagonal = box_diagonal(mesh);
  return {mesh.unit, box_of(mesh).size(), diagonal, kCoordinateStep * diagonal, false};
}

LengthBasis unknown_basis() { return {"", {1, 1, 1}, 1, 0, false}; }

Length parse_error_length(std::string_view option, const std::string& text, const LengthBasis& basis) {
  const std::optional<Length> length = to_length(text, basis);
  if (!length || !(length->value >= 0)) wrong_length(option, "of at least 0", text);
  return *length;
}

Length parse_positive_length(std::string_view option, const std::string& text, const LengthBasis& basis) {
  const std::optional<Length> length = to_length(text, basis);
  if (!length || !(length->value > 0)) wrong_length(option, "above 0", text);
  return *length;
}

void tell_lengths(const std::string& path, const std::vector<GivenLength>& lengths, bool stated,
                  const LengthBasis& basis) {
  const std::string size = size_text(basis.size, basis.unit);
  const bool metric = std::ranges::any_of(lengths, is_metric_length, &GivenLength::text);
  if (basis.unit.empty() && (metric || stated)) {
    print_note(fmt::format("{}: does not say its unit: lengths are taken for it to be mm{}, and so it is {} large",
                           path, basis.is_volume ? " (--unit says otherwise)" : "", size));
  }
  for (const auto& [option, text] : lengths) {
    const std::optional<double> length = length_of_unit(option, text, basis);
    const std::string_view wrong = length ? misfit(*length, basis) : "";
    if (wrong.empty()) continue;
    print_note(fmt::format("warning: {} {} is {:.4g} {}, and the {} is {} large: {}; is the unit right?", option, text,
                           *length, unit_text(basis.unit), basis.is_volume ? "volume" : "mesh", size, wrong));
  }
}

}  // namespace isoweave::cli
