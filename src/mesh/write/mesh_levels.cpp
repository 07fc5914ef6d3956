#include "mesh/write/mesh_levels.hpp"

#include <stdexcept>
#include <utility>

#include "isoweave/error.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/whole_mesh_sink.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kRecordBytes = 12;  // of a position, a normal, a face

// The sink of one level. The file stays open as long as one of its levels does.
class LevelSink final : public MeshSink {
 public:
  LevelSink(std::shared_ptr<LevelFile> file, std::size_t level) : file_(std::move(file)), level_(level) {}

  void append(const MeshPiece& piece) override { file_->level(level_).append(piece); }
  void finish() override { file_->finish(level_); }
  std::string mark() override { return file_->level(level_).mark(); }
  void forget_marks() override { file_->level(level_).forget_marks(); }
  std::array<double, 3> offset() const override { return file_->level(level_).offset(); }
  std::vector<std::string> notes() const override {
    return file_->is_last(level_) ? file_->notes() : std::vector<std::string>{};
  }

 private:
  std::shared_ptr<LevelFile> file_;
  std::size_t level_;
};

std::shared_ptr<LevelFile> open_levels(const std::string& path, std::span<const MeshFileOptions> levels) {
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

}  // namespace

LevelParts::LevelParts(LevelFile& file, const std::string& path, const MeshFileOptions& options)
    : MeshFileSink({path, MeshTarget::Kind::kLevel}, options),
      file_(file),
      positions_(open_side("positions.part")),
      faces_(open_side("faces.part")) {
  if (options.normals) normals_ = &open_side("normals.part");
  if (continued()) bounds_.load(saved_state(6));
}

void LevelParts::write_piece(const MeshPiece& piece) {
  file_.check_room(*this, piece.vertices.size(), piece.triangles.size());
  bounds_.add(piece.vertices);
  write_records(positions_, records_, piece.vertices.size(), kRecordBytes,
                [&](std::byte*& out, std::size_t n) { store_point(out, piece.vertices[n]); });
  if (normals_ != nullptr) {
    write_records(*normals_, records_, piece.normals.size(), kRecordBytes,
                  [&](std::byte*& out, std::size_t n) { store_point(out, gltf_normal(piece.normals[n])); });
  }
  write_records(faces_, records_, piece.triangles.size(), kRecordBytes,
                [&](std::byte*& out, std::size_t n) { store_indices(out, piece.triangles[n]); });
}

void LevelParts::append_to(AtomicFile& target) {
  target.append(positions_);
  if (normals_ != nullptr) target.append(*normals_);
  target.append(faces_);
}

TriangleMesh LevelParts::load() {
  TriangleMesh mesh;
  mesh.vertices = read_all<Point>(positions_, vertices());
  mesh.triangles = read_all<std::array<std::uint32_t, 3>>(faces_, triangles());
  if (normals_ != nullptr) mesh.normals = read_all<Point>(*normals_, vertices());
  return mesh;
}

LevelFile::LevelFile(const std::string& path, std::span<const MeshFileOptions> levels) : path_(path) {
  for (const MeshFileOptions& options : levels) levels_.emplace_back(*this, path, options);
}

void LevelFile::finish(std::size_t level) {
  levels_[level].finish();
  if (++finished_ < levels_.size()) return;
  write();
}

std::vector<std::unique_ptr<MeshSink>> open_mesh_levels(const std::string& path,
                                                        std::span<const MeshFileOptions> levels) {
  if (levels.empty()) throw std::invalid_argument(path + ": expected one level of detail or more, found none");
  for (const MeshFileOptions& options : levels) {
    if (options.compress != levels.front().compress || options.normals != levels.front().normals) {
      throw std::invalid_argument(path + ": expected levels with the same options for normals and packing");
    }
    if (options.offset != levels.front().offset) {
      throw std::invalid_argument(path + ": expected levels with the same offset");
    }
  }
  const std::shared_ptr<LevelFile> file = open_levels(path, levels);
  std::vector<std::unique_ptr<MeshSink>> sinks;
  for (std::size_t level = 0; level < levels.size(); ++level) sinks.push_back(std::make_unique<LevelSink>(file, level));
  return sinks;
}

}  // namespace isoweave
