// bench_peers: one suite on one volume, results as JSON.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <thread>

#include "suites.hpp"

namespace bench {
namespace {

// With one thread, and with all.
Settings default_settings() {
  Settings settings;
  const int all = static_cast<int>(std::thread::hardware_concurrency());
  if (all > 1) settings.threads.push_back(all);
  return settings;
}

struct Arguments {
  std::string suite, output;
  SuiteInput input;
  std::vector<double> left{50, 20, 10, 5, 1};
  Settings settings = default_settings();
};

void add_options(CLI::App& app, Arguments& arguments) {
  SuiteInput& input = arguments.input;
  Settings& settings = arguments.settings;
  app.add_option("SUITE", arguments.suite)->required()->check(CLI::IsMember({"extract", "simplify", "job"}));
  app.add_option("VOLUME", input.volume.path, "File, or generate:KIND:WxHxD:TYPE")->required();
  app.add_option("--raw", input.volume.raw, "Layout of a headerless file: WxHxD:TYPE");
  app.add_option("--spacing", input.volume.spacing, "x,y,z, instead of the file's");
  app.add_option("--iso", input.iso)->required();
  app.add_option("--name", input.name, "Of the volume, in the results")->required();
  app.add_option("--left", arguments.left, "Percentages of the triangles to be left")->delimiter(',');
  app.add_option("--threads", settings.threads, "Without it: one, and all")->delimiter(',');
  app.add_option("--rounds", settings.most_rounds, "Of a pair, at most");
  app.add_option("--enough", settings.enough_seconds, "Seconds after which a pair has no further round");
  app.add_option("--only", settings.only, "Only peers with this in their name");
  app.add_option("--limit", settings.limit_seconds, "Seconds that one run may take");
  app.add_option("--scratch", input.scratch, "Folder for files that are needed meanwhile")->required();
  app.add_option("-o,--output", arguments.output, "JSON")->required();
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

// With the load at the start: figures from a machine that is busy otherwise are worth less.
Json machine() {
  std::array<double, 1> load{};
  getloadavg(load.data(), 1);
  return {{"processor", processor_name()},
          {"threads", std::thread::hardware_concurrency()},
          {"load", load[0]},
          {"compiler", __VERSION__}};
}

Json run_suite(const Arguments& arguments) {
  if (arguments.suite == "extract") return extract_suite(arguments.input, arguments.settings);
  if (arguments.suite == "simplify") return simplify_suite(arguments.input, arguments.left, arguments.settings);
  return job_suite(arguments.input, arguments.left, arguments.settings);
}

void run(const Arguments& arguments) {
  Json json{{"suite", arguments.suite}, {"machine", machine()}};
  json.update(run_suite(arguments));
  std::ofstream file(arguments.output);
  file << json.dump(1) << '\n';
  if (!file.flush()) throw std::runtime_error("cannot write " + arguments.output);
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  CLI::App app("Measures isoweave beside other libraries");
  bench::Arguments arguments;
  bench::add_options(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    bench::run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "bench_peers: " << arguments.input.name << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}
