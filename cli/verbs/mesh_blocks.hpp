// The option --blocks: whether isoweave mesh takes a volume in blocks, and which.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "isoweave/blocks.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// The folder of an output, for parts that wait.
std::string folder_beside(const OutputOptions& output);

// The size of blocks that is asked for by a number; none for auto and off.
std::optional<std::int64_t> asked_blocks(const MeshArguments& arguments);

// Whether auto may take blocks for a volume in place of slabs that do not fit into --memory.
bool may_take_blocks(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control,
                     const SliceSource& volume);

// Meshes the input in blocks. With a cap on memory, what waits from block to block waits in files beside the output.
MeshReport mesh_input_in_blocks(const MeshArguments& arguments, std::int64_t size, std::span<MeshSink* const> sinks,
                                const MeshOptions& options, const RunControl& control);

}  // namespace isoweave::cli
