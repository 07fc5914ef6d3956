// The three comparisons: extraction, simplification, and the whole job.
#pragma once

#include <string>
#include <vector>

#include "input.hpp"
#include "pairs.hpp"

namespace bench {

struct SuiteInput {
  std::string name;  // for people
  VolumeName volume;
  double iso = 0;
  std::string scratch;  // folder for the full surface and the raw file
};

// Each gives what was measured of one input. `left`: percentages of the full surface's triangles.
Json extract_suite(const SuiteInput& input, const Settings& settings);
Json simplify_suite(const SuiteInput& input, const std::vector<double>& left, const Settings& settings);
Json job_suite(const SuiteInput& input, const std::vector<double>& left, const Settings& settings);

}  // namespace bench
