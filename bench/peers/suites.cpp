#include "suites.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"

namespace bench {
namespace {

Json describe(const SuiteInput& input, const isoweave::VolumeInfo& info) {
  return {{"name", input.name},
          {"dims", info.dims},
          {"type", isoweave::sample_type_name(info.type)},
          {"iso", input.iso},
          {"voxel", mean_voxel(info)}};
}

// What a child makes for its parent lies in a file; without it there is nothing to compare.
Json need(const Outcome& outcome, const std::string& what) {
  if (!outcome.failure.empty()) throw std::runtime_error(what + ": " + outcome.failure);
  return outcome.result;
}

std::string ratio_text(const Json& row) {
  if (row["peer"].contains("failure")) return row["peer"]["failure"];
  if (row["ours"].contains("failure")) return "isoweave: " + row["ours"]["failure"].get<std::string>();
  return std::to_string(row["ratio"].get<double>()) + " times our time";
}

void add_rows(Json& rows, std::vector<Json> more, double left) {
  for (Json& row : more) {
    row["left"] = left;
    std::cerr << left << " % left, " << row["threads"] << " threads, " << row["peer"]["name"].get<std::string>() << ": "
              << ratio_text(row) << '\n';
    rows.push_back(std::move(row));
  }
}

// Extracts the full surface into a file, as every simplifier gets it.
Json extract_full(const SuiteInput& input, const FullSurface& full, double limit) {
  const auto work = [&]() -> Json {
    const auto source = open_source(input.volume);
    const auto file = isoweave::open_mesh_file(full.path);
    isoweave::MeshOptions options = isoweave::full_surface({.iso = input.iso, .closed = false});
    options.space = isoweave::OutputSpace::kIndex;
    mesh_volume(*source, *file, options);
    const isoweave::MeshCheck check = check_mesh(isoweave::read_mesh(full.path));
    return {{"triangles", check.triangles}, {"euler", check.euler}, {"components", check.components}};
  };
  return need(run_in_child(work, limit), "the full surface");
}

// One that cannot be brought to the count is a row with the reason.
Json not_steered(const Runner& ours, const Runner& peer, const std::string& failure) {
  return {{"threads", 0}, {"ours", {{"name", ours.name}}}, {"peer", {{"name", peer.name}, {"failure", failure}}}};
}

// Everybody against the first, at the count that the first leaves.
void compare_at(double left, std::size_t wanted, const std::vector<Runner>& runners, const Settings& settings,
                const FullSurface& full, Json& rows) {
  const int most_threads = *std::max_element(settings.threads.begin(), settings.threads.end());
  Entry ours{runners.front(), {.triangles = wanted, .threads = most_threads}};
  const std::string failure = steer(ours.runner, full.voxel, settings.limit_seconds, ours.goal);
  if (!failure.empty()) throw std::runtime_error(ours.runner.name + ": " + failure);
  for (std::size_t r = 1; r < runners.size(); ++r) {
    Entry peer{runners[r], {.triangles = ours.goal.triangles, .threads = most_threads}};
    const std::string problem =
        peer.runner.steering ? steer(peer.runner, full.voxel, settings.limit_seconds, peer.goal) : std::string();
    add_rows(rows,
             problem.empty() ? compare(ours, peer, settings, &full)
                             : std::vector<Json>{not_steered(ours.runner, peer.runner, problem)},
             left);
  }
}

// The first, and the peers that are asked for.
template <class Input>
std::vector<Runner> bind_all(const std::vector<Contestant<Input>>& contestants, const Input& input,
                             const Settings& settings) {
  std::vector<Runner> runners;
  for (const Contestant<Input>& contestant : contestants) {
    const bool wanted = runners.empty() || contestant.name.find(settings.only) != std::string::npos;
    if (wanted) runners.push_back(bind(contestant, input));
  }
  return runners;
}

std::size_t share(const Json& full, double left) {
  return static_cast<std::size_t>(std::lround(full["triangles"].get<double>() * left / 100));
}

}  // namespace

Json extract_suite(const SuiteInput& input, const Settings& settings) {
  const Contestants contestants = all_contestants();
  const HeldVolume volume = hold(*open_source(input.volume), input.iso);
  const std::vector<Runner> runners = bind_all(contestants.extractors, volume, settings);
  Json rows = Json::array();
  for (std::size_t r = 1; r < runners.size(); ++r) {
    Entry ours{runners.front(), {}}, peer{runners[r], {}};
    add_rows(rows, compare(ours, peer, settings, nullptr), 100);
  }
  return {{"input", describe(input, volume.info)}, {"rows", rows}, {"absent", contestants.absent}};
}

Json simplify_suite(const SuiteInput& input, const std::vector<double>& left, const Settings& settings) {
  const Contestants contestants = all_contestants();
  const isoweave::VolumeInfo info = open_source(input.volume)->info();
  const FullSurface full{input.scratch + "/full.ply", mean_voxel(info)};
  const Json surface = extract_full(input, full, settings.limit_seconds);
  const isoweave::TriangleMesh mesh = isoweave::read_mesh(full.path);
  const std::vector<Runner> runners = bind_all(contestants.simplifiers, mesh, settings);
  Json rows = Json::array();
  for (const double percent : left) compare_at(percent, share(surface, percent), runners, settings, full, rows);
  return {{"input", describe(input, info)}, {"full", surface}, {"rows", rows}, {"absent", contestants.absent}};
}

Json job_suite(const SuiteInput& input, const std::vector<double>& left, const Settings& settings) {
  const Contestants contestants = all_contestants();
  const auto source = open_source(input.volume);
  const isoweave::VolumeInfo info = source->info();
  const FullSurface full{input.scratch + "/full.ply", mean_voxel(info)};
  const Json surface = extract_full(input, full, settings.limit_seconds);
  const VolumeFile file = write_raw(*source, input.iso, input.scratch + "/volume.raw");
  const std::vector<Runner> runners = bind_all(contestants.jobs, file, settings);
  Json rows = Json::array();
  for (const double percent : left) compare_at(percent, share(surface, percent), runners, settings, full, rows);
  return {{"input", describe(input, info)}, {"full", surface}, {"rows", rows}, {"absent", contestants.absent}};
}

}  // namespace bench
