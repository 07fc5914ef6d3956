// PLY, binary little-endian. All vertices stand before all faces in the file, but pieces bring both: the faces go
// to a scratch file beside the target and are appended at the end.
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kFaceBytes = 1 + 3 * 4;

// The counts are known last, so the header is written twice and must keep its length: a comment line takes the digits
// that the counts do not need. (Padding the numbers themselves trips readers that split lines at single blanks.)
std::string ply_header(const MeshFileOptions& options, std::uint64_t vertices, std::uint64_t faces) {
  constexpr std::size_t kDigits = 40;
  const std::string vertex_count = std::to_string(vertices);
  const std::string face_count = std::to_string(faces);
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comment_lines(options)) text += "comment " + comment + "\n";
  text += "comment padding " + std::string(kDigits - vertex_count.size() - face_count.size(), '.') + "\n";
  text += "element vertex " + vertex_count + "\n";
  for (const char* name : {"x", "y", "z"}) {
    text += std::string("property ") + (has_offset(options) ? "double " : "float ") + name + "\n";
  }
  if (options.normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (options.values) text += "property float quality\n";
  text += "element face " + face_count + "\nproperty list uchar uint vertex_indices\nend_header\n";
  return text;
}

class PlySink final : public MeshFileSink {
 public:
  PlySink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, options), faces_(open_side("faces.part")) {
    const std::string header = ply_header(options, 0, 0);
    header_bytes_ = header.size();
    if (!continued()) file().write(std::as_bytes(std::span(header)));
  }

 private:
  std::size_t vertex_bytes() const {
    return std::size_t{has_offset() ? 24U : 12U} + (options().normals ? 12 : 0) + (options().values ? 4 : 0);
  }

  void write_piece(const MeshPiece& piece) override {
    check_count_fits(path(), "vertices", this->vertices(), piece.vertices.size());
    write_records(file(), records_, piece.vertices.size(), vertex_bytes(), [&](std::byte*& out, std::size_t n) {
      has_offset() ? store_wide_point(out, placed(piece.vertices[n])) : store_point(out, piece.vertices[n]);
      if (!piece.normals.empty()) store_point(out, piece.normals[n]);
      if (!piece.values.empty()) store_u32(out, std::bit_cast<std::uint32_t>(piece.values[n]));
    });
    write_records(faces_, records_, piece.triangles.size(), kFaceBytes, [&](std::byte*& out, std::size_t n) {
      *out++ = std::byte{3};
      store_indices(out, piece.triangles[n]);
    });
  }

  void complete() override {
    file().append(faces_);
    const std::string header = ply_header(options(), vertices(), triangles());
    file().overwrite(0, std::as_bytes(std::span(header)));
    check_written(header_bytes_ + vertices() * vertex_bytes() + triangles() * kFaceBytes,
                  std::as_bytes(std::span(header)));
  }

  OutputDescriptor& faces_;
  std::vector<std::byte> records_;
  std::uint64_t header_bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshSink> open_ply(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<PlySink>(target, options);
}

}  // namespace isoweave
