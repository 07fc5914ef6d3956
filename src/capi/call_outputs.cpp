#include "capi/call_outputs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

#include "capi/guard.hpp"
#include "isoweave/error.hpp"

namespace isoweave::capi {
namespace {

// Pieces to the caller's callbacks.
class CallbackSink final : public MeshSink {
 public:
  CallbackSink(const iw_sink& sink, const std::array<double, 3>& offset) : sink_(sink), offset_(offset) {
    if (sink.append == nullptr) throw std::invalid_argument("sink: expected a callback append, found NULL");
  }

  std::array<double, 3> offset() const override { return offset_; }

  void append(const MeshPiece& piece) override {
    iw_piece told{};
    told.struct_size = sizeof told;
    told.vertices = piece.vertices.size();
    told.triangles = piece.triangles.size();
    told.points = piece.vertices.empty() ? nullptr : piece.vertices.front().data();
    told.normals = piece.normals.empty() ? nullptr : piece.normals.front().data();
    told.values = piece.values.data();
    told.corners = piece.triangles.empty() ? nullptr : piece.triangles.front().data();
    std::ranges::copy(offset_, told.offset);
    if (sink_.append(sink_.context, &told) != 0) throw Interrupted("stopped by the sink");
  }

  void finish() override {
    if (sink_.finish != nullptr && sink_.finish(sink_.context) != 0) throw Interrupted("stopped by the sink");
  }

 private:
  const iw_sink sink_;
  const std::array<double, 3> offset_;
};

// The outputs of the caller, whose header may have a shorter struct.
std::vector<iw_output> taken_outputs(const iw_output* outputs, std::size_t count) {
  std::vector<iw_output> all;
  if (count == 0) return all;
  const std::size_t stride = required(outputs, "outputs").struct_size;
  if (stride < offsetof(iw_output, mesh) + sizeof(iw_mesh*))
    throw std::invalid_argument("outputs: expected structs with a place for a mesh, found smaller ones");
  const auto* next = reinterpret_cast<const std::byte*>(outputs);
  for (std::size_t n = 0; n < count; ++n, next += stride) {
    const auto* output = reinterpret_cast<const iw_output*>(next);
    if (output->struct_size != stride) throw std::invalid_argument("outputs: expected structs of one size");
    all.push_back(taken(output));
  }
  return all;
}

}  // namespace

CallOutputs::CallOutputs(iw_output* outputs, std::size_t count, MeshFileOptions file,
                         const std::vector<UnfinishedMesh>& unfinished)
    : given_(outputs), outputs_(taken_outputs(outputs, count)) {
  for (const iw_output& output : outputs_) {
    if (!unfinished.empty()) {
      if (output.path == nullptr) throw std::invalid_argument("checkpoint: expected outputs that are files");
      file.parts = unfinished[pointers_.size()].parts;
      file.mark = unfinished[pointers_.size()].mark;
    }
    pointers_.push_back(open(output, file));
  }
}

MeshSink* CallOutputs::open(const iw_output& output, const MeshFileOptions& file) {
  if (output.path != nullptr && output.sink != nullptr)
    throw std::invalid_argument("outputs: expected a path or a sink, found both");
  meshes_.emplace_back();
  if (output.path != nullptr) {
    MeshFileOptions options = file;
    options.compress = output.compress != 0;
    options.values = options.values && holds_values(mesh_format(output.path));
    sinks_.push_back(open_mesh_file(output.path, options));
    return sinks_.back().get();
  }
  if (output.sink != nullptr) {
    sinks_.push_back(std::make_unique<CallbackSink>(taken(output.sink), file.offset));
    return sinks_.back().get();
  }
  meshes_.back() = std::make_unique<iw_mesh>(iw_mesh{MeshInMemory(file.offset), file.unit, file.space});
  return &std::get<MeshInMemory>(meshes_.back()->content);
}

void CallOutputs::deliver() {
  if (meshes_.empty()) return;
  auto* next = reinterpret_cast<std::byte*>(given_);
  for (std::unique_ptr<iw_mesh>& mesh : meshes_) {
    auto* output = reinterpret_cast<iw_output*>(next);
    if (mesh != nullptr) output->mesh = mesh.release();
    next += output->struct_size;
  }
}

std::vector<std::string> CallOutputs::notes() const {
  std::vector<std::string> all;
  for (const MeshSink* sink : pointers_) {
    for (std::string& note : sink->notes()) all.push_back(std::move(note));
  }
  return all;
}

}  // namespace isoweave::capi
