#include "mesh/read/mesh_leftovers.hpp"

#include <algorithm>

#include "isoweave/printable.hpp"

namespace isoweave::mesh_io {
namespace {

// Clouds of Gaussian splats have sixty properties.
constexpr std::size_t kMostNames = 12;
constexpr std::size_t kLongestName = 60;

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t n = 0; n < std::min(names.size(), kMostNames); ++n) text += (n == 0 ? "" : ", ") + names[n];
  if (names.size() > kMostNames) text += " and " + std::to_string(names.size() - kMostNames) + " more";
  return text;
}

}  // namespace

void MeshLeftovers::not_kept(std::string_view what) {
  const std::string name = printable(what.substr(0, kLongestName));
  if (std::find(not_kept_.begin(), not_kept_.end(), name) == not_kept_.end()) not_kept_.push_back(name);
}

void MeshLeftovers::left_out(std::uint64_t count, std::string_view what) {
  if (count == 0) return;
  const std::string name = printable(what.substr(0, kLongestName));
  const auto known =
      std::find_if(left_out_.begin(), left_out_.end(), [&](const auto& entry) { return entry.first == name; });
  if (known != left_out_.end()) {
    known->second += count;
  } else {
    left_out_.emplace_back(name, count);
  }
}

void MeshLeftovers::note(TriangleMesh& mesh) const {
  if (!not_kept_.empty()) mesh.notes.push_back("not kept: " + list(not_kept_));
  std::vector<std::string> counted;
  counted.reserve(left_out_.size());
  for (const auto& [what, count] : left_out_) counted.push_back(std::to_string(count) + " " + what);
  if (!counted.empty()) mesh.notes.push_back("left out: " + list(counted));
}

}  // namespace isoweave::mesh_io
