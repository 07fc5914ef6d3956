// Where the meshes of a call go.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "capi/call_checkpoint.hpp"
#include "capi/handles.hpp"
#include "isoweave/isoweave.h"
#include "isoweave/mesh.hpp"

namespace isoweave::capi {

// The sinks of a call, in the order of its outputs.
class CallOutputs {
 public:
  // Opens all outputs. file: the options of mesh files, and the unit, space and offset of all meshes. unfinished: where
  // the mesh of each output is kept while it is not finished; empty: nowhere.
  // @throws std::invalid_argument, CannotWrite
  CallOutputs(iw_output* outputs, std::size_t count, MeshFileOptions file,
              const std::vector<UnfinishedMesh>& unfinished = {});

  std::span<MeshSink* const> pointers() const { return pointers_; }
  const iw_output& operator[](std::size_t n) const { return outputs_[n]; }

  // Hands the meshes in memory to the caller. Either all or none.
  void deliver();

  std::vector<std::string> notes() const;

 private:
  MeshSink* open(const iw_output& output, const MeshFileOptions& file);

  iw_output* given_;
  std::vector<iw_output> outputs_;
  std::vector<std::unique_ptr<iw_mesh>> meshes_;  // null for outputs that are elsewhere
  std::vector<std::unique_ptr<MeshSink>> sinks_;
  std::vector<MeshSink*> pointers_;
};

}  // namespace isoweave::capi
