// The folder in which results of blocks are kept.
#pragma once

#include <optional>
#include <string>

#include "pipeline/parts/task_file.hpp"

namespace isoweave {

// The mesh that results in a folder belong to; nothing where there are none. Throws BadInput.
std::optional<TaskIdentity> identity_of_results(const std::string& folder);

}  // namespace isoweave
