// PLY, binary little-endian. All vertices stand before all faces in the file, but pieces bring both: the faces go
// to a scratch file beside the target and are appended at the end.
#include <algorithm>
#include <vector>

#include "write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kFaceBytes = 1 + 3 * 4;
constexpr std::size_t kRecordsAtOnce = 4096;

// The counts are known last, so the header is written twice and must keep its length: a comment line takes the digits
// that the counts do not need. (Padding the numbers themselves trips readers that split lines at single blanks.)
std::string header_text(const MeshFileOptions& options, std::uint64_t vertices, std::uint64_t faces) {
  constexpr std::size_t kDigits = 40;
  const std::string vertex_count = std::to_string(vertices);
  const std::string face_count = std::to_string(faces);
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : options.comments) text += "comment " + one_line(comment) + "\n";
  text += "comment padding " + std::string(kDigits - vertex_count.size() - face_count.size(), '.') + "\n";
  text += "element vertex " + vertex_count + "\nproperty float x\nproperty float y\nproperty float z\n";
  if (options.normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  text += "element face " + face_count + "\nproperty list uchar uint vertex_indices\nend_header\n";
  return text;
}

class PlySink final : public MeshFileSink {
 public:
  PlySink(const std::string& path, const MeshFileOptions& options)
      : MeshFileSink(path, options), faces_(open_side("faces.part")) {
    const std::string header = header_text(options, 0, 0);
    header_bytes_ = header.size();
    if (!continued()) file().write(std::as_bytes(std::span(header)));
  }

 private:
  std::size_t vertex_bytes() const { return options().normals ? 24 : 12; }

  void write_piece(std::span<const Point> vertices, std::span<const Point> normals,
                   std::span<const Triangle64> triangles) override {
    check_count_fits(path(), "vertices", this->vertices(), vertices.size());
    write_vertices(vertices, normals);
    write_faces(triangles);
  }

  void write_vertices(std::span<const Point> vertices, std::span<const Point> normals) {
    records_.resize(kRecordsAtOnce * vertex_bytes());
    for (std::size_t first = 0; first < vertices.size(); first += kRecordsAtOnce) {
      const std::size_t end = std::min(vertices.size(), first + kRecordsAtOnce);
      std::byte* out = records_.data();
      for (std::size_t i = first; i < end; ++i) {
        store_point(out, vertices[i]);
        if (!normals.empty()) store_point(out, normals[i]);
      }
      file().write(std::span(records_).first((end - first) * vertex_bytes()));
    }
  }

  void write_faces(std::span<const Triangle64> triangles) {
    records_.resize(kRecordsAtOnce * kFaceBytes);
    for (std::size_t first = 0; first < triangles.size(); first += kRecordsAtOnce) {
      const std::size_t end = std::min(triangles.size(), first + kRecordsAtOnce);
      std::byte* out = records_.data();
      for (std::size_t i = first; i < end; ++i) {
        *out++ = std::byte{3};
        for (const std::uint64_t index : triangles[i]) store_u32(out, static_cast<std::uint32_t>(index));
      }
      faces_.write(std::span(records_).first((end - first) * kFaceBytes));
    }
  }

  void complete() override {
    file().append(faces_);
    const std::string header = header_text(options(), vertices(), triangles());
    file().overwrite(0, std::as_bytes(std::span(header)));
    check_written(header_bytes_ + vertices() * vertex_bytes() + triangles() * kFaceBytes,
                  std::as_bytes(std::span(header)));
  }

  OutputDescriptor& faces_;
  std::vector<std::byte> records_;
  std::uint64_t header_bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshSink> open_ply(const std::string& path, const MeshFileOptions& options) {
  return std::make_unique<PlySink>(path, options);
}

}  // namespace isoweave
