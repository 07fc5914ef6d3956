#include "mesh/write/joined_meshes.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "isoweave/error.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/whole_mesh_sink.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kRecordBytes = 12;  // of a position, a normal, a narrow face

// The sink of one mesh. The file stays open as long as one of its meshes does.
class JoinedSink final : public MeshSink {
 public:
  JoinedSink(std::shared_ptr<JoinedFile> file, std::size_t mesh) : file_(std::move(file)), mesh_(mesh) {}

  void append(const MeshPiece& piece) override { file_->mesh(mesh_).append(piece); }
  void finish() override { file_->finish(mesh_); }
  std::string mark() override { return file_->mesh(mesh_).mark(); }
  void forget_marks() override { file_->mesh(mesh_).forget_marks(); }
  std::array<double, 3> offset() const override { return file_->mesh(mesh_).offset(); }
  std::vector<std::string> notes() const override {
    return file_->is_last(mesh_) ? file_->notes() : std::vector<std::string>{};
  }

 private:
  std::shared_ptr<JoinedFile> file_;
  std::size_t mesh_;
};

std::shared_ptr<JoinedFile> open_levels(const std::string& path, std::span<const MeshFileOptions> levels) {
  const MeshFileOptions& first = levels.front();
  switch (checked_mesh_format(path, first)) {
    case MeshFormat::kGlb:
      return first.compress ? open_packed_glb_levels(path, levels) : open_glb_levels(path, levels);
    case MeshFormat::kPrecomputed:
      if (first.compress) return open_packed_precomputed_levels(path, levels);
      break;
    default:
      break;
  }
  throw CannotWrite(path + ": expected .glb, or .precomputed that is compressed, for several levels in one file");
}

std::shared_ptr<JoinedFile> open_parts(const std::string& path, std::span<const MeshPart> parts) {
  const MeshFileOptions& first = parts.front().options;
  switch (checked_mesh_format(path, first)) {
    case MeshFormat::kGlb:
      return first.compress ? open_packed_glb_parts(path, parts) : open_glb_parts(path, parts);
    case MeshFormat::kVtp:
      return open_vtp_parts(path, parts);
    default:
      break;
  }
  throw CannotWrite(path + ": expected a name that ends in .glb or .vtp for several parts in one file");
}

// Refuses meshes that do not go into one file. `kind`: "level of detail", say.
void check_alike(const std::string& path, std::span<const MeshFileOptions> meshes, const std::string& kind) {
  if (meshes.empty()) throw std::invalid_argument(path + ": expected one " + kind + " or more, found none");
  const MeshFileOptions& first = meshes.front();
  const bool alike = std::ranges::all_of(meshes, [&](const MeshFileOptions& options) {
    return options.compress == first.compress && options.normals == first.normals && options.values == first.values;
  });
  if (!alike) {
    throw std::invalid_argument(path + ": expected the same options for normals, values and packing of each " + kind);
  }
  if (!std::ranges::all_of(meshes, [&](const MeshFileOptions& options) { return options.offset == first.offset; })) {
    throw std::invalid_argument(path + ": expected the same offset of each " + kind);
  }
}

std::vector<std::unique_ptr<MeshSink>> sinks_of(const std::shared_ptr<JoinedFile>& file, std::size_t count) {
  std::vector<std::unique_ptr<MeshSink>> sinks;
  for (std::size_t mesh = 0; mesh < count; ++mesh) sinks.push_back(std::make_unique<JoinedSink>(file, mesh));
  return sinks;
}

}  // namespace

JoinedMesh::JoinedMesh(JoinedFile& file, const std::string& path, const MeshFileOptions& options, JoinedForm form)
    : MeshFileSink({path, MeshTarget::Kind::kJoined}, options),
      file_(file),
      form_(form),
      positions_(open_side("positions.part")),
      faces_(open_side("faces.part")) {
  if (options.normals) normals_ = &open_side("normals.part");
  if (options.values) values_ = &open_side("values.part");
  if (continued()) bounds_.load(saved_state(6));
}

void JoinedMesh::write_piece(const MeshPiece& piece) {
  file_.check_room(*this, piece.vertices.size(), piece.triangles.size());
  bounds_.add(piece.vertices);
  if (values_ != nullptr) values_->write(std::as_bytes(piece.values));
  if (form_ == JoinedForm::kNarrow) return write_narrow(piece);
  positions_.write(std::as_bytes(piece.vertices));
  if (normals_ != nullptr) normals_->write(std::as_bytes(piece.normals));
  faces_.write(std::as_bytes(piece.triangles));
}

void JoinedMesh::write_narrow(const MeshPiece& piece) {
  write_records(positions_, records_, piece.vertices.size(), kRecordBytes,
                [&](std::byte*& out, std::size_t n) { store_point(out, piece.vertices[n]); });
  if (normals_ != nullptr) {
    write_records(*normals_, records_, piece.normals.size(), kRecordBytes,
                  [&](std::byte*& out, std::size_t n) { store_point(out, gltf_normal(piece.normals[n])); });
  }
  write_records(faces_, records_, piece.triangles.size(), kRecordBytes,
                [&](std::byte*& out, std::size_t n) { store_indices(out, piece.triangles[n]); });
}

void JoinedMesh::append_to(AtomicFile& target) {
  target.append(positions_);
  if (normals_ != nullptr) target.append(*normals_);
  target.append(faces_);
}

TriangleMesh JoinedMesh::load() {
  TriangleMesh mesh;
  mesh.vertices = read_all<Point>(positions_, vertices());
  mesh.triangles = read_all<std::array<std::uint32_t, 3>>(faces_, triangles());
  if (normals_ != nullptr) mesh.normals = read_all<Point>(*normals_, vertices());
  return mesh;
}

JoinedFile::JoinedFile(const std::string& path, std::span<const MeshFileOptions> meshes, JoinedForm form)
    : path_(path) {
  for (const MeshFileOptions& options : meshes) meshes_.emplace_back(*this, path, options, form);
}

void JoinedFile::finish(std::size_t mesh) {
  meshes_[mesh].finish();
  if (++finished_ < meshes_.size()) return;
  write();
}

std::vector<Point> JoinedFile::corners() const {
  std::vector<Point> corners;
  for (const JoinedMesh& mesh : meshes_) {
    if (mesh.vertices() == 0) continue;
    corners.push_back(mesh.bounds().low);
    corners.push_back(mesh.bounds().high);
  }
  return corners;
}

std::vector<MeshFileOptions> options_of(std::span<const MeshPart> parts) {
  std::vector<MeshFileOptions> options;
  for (const MeshPart& part : parts) options.push_back(part.options);
  return options;
}

std::vector<std::unique_ptr<MeshSink>> open_mesh_levels(const std::string& path,
                                                        std::span<const MeshFileOptions> levels) {
  check_alike(path, levels, "level of detail");
  return sinks_of(open_levels(path, levels), levels.size());
}

std::unique_ptr<MeshObjects> open_mesh_objects(const std::string& path, const MeshFileOptions& options) {
  if (checked_mesh_format(path, options) != MeshFormat::kPrecomputed || !options.compress) {
    throw CannotWrite(path + ": expected .precomputed that is compressed, for objects with numbers in one folder");
  }
  return open_packed_precomputed_objects(path, options);
}

std::vector<std::unique_ptr<MeshSink>> open_mesh_parts(const std::string& path, std::span<const MeshPart> parts) {
  check_alike(path, options_of(parts), "part");
  for (const MeshPart& part : parts) {
    for (const double channel : part.color) {
      if (!(channel >= 0 && channel <= 1)) {
        throw std::invalid_argument(path + ": expected colours and opacities of parts from 0 to 1");
      }
    }
  }
  return sinks_of(open_parts(path, parts), parts.size());
}

}  // namespace isoweave
