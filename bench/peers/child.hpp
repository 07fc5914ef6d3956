// Work in a forked process: its peak memory is its own, and its crash is a result.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace bench {

using Json = nlohmann::json;

struct Outcome {
  Json result;
  std::string failure;  // one line; empty when there is a result
};

// The caller must not have started threads, which do not live on in a forked process.
Outcome run_in_child(const std::function<Json()>& work, double limit_seconds);

}  // namespace bench
