// Work in a forked process: its peak memory is its own, and its crash is a result.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace bench {

using Json = nlohmann::json;

struct Outcome {
  Json result;
  std::string failure;  // one line; empty when there is a result
};

// Touches memory and gives it back to this system, which hands it out again next. A virtual machine's host provides
// memory when it is touched first, and takes back what is free, in large pieces: no run that is measured is to pay for
// that.
void have_host_provide_memory(std::int64_t bytes);

// The caller must not have started threads, which do not live on in a forked process.
Outcome run_in_child(const std::function<Json()>& work, double limit_seconds);

}  // namespace bench
