// PLY of a mesh that is there as a whole, with a number at each vertex.
#include <cstring>
#include <stdexcept>
#include <vector>

#include "isoweave/mesh.hpp"
#include "write/atomic_file.hpp"

namespace isoweave {
namespace {

// What is written at a time.
class Records {
 public:
  explicit Records(AtomicFile& file) : file_(file) { bytes_.reserve(kRoom); }

  template <class T>
  void add(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  void end_record() {
    if (bytes_.size() + kLongest > kRoom) flush();
  }

  void flush() {
    file_.write(bytes_);
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kRoom = std::size_t{1} << 20;
  static constexpr std::size_t kLongest = 64;

  AtomicFile& file_;
  std::vector<std::byte> bytes_;
};

}  // namespace

void write_ply_with_quality(const std::string& path, const TriangleMesh& mesh, std::span<const float> quality,
                            std::span<const std::string> comments) {
  if (quality.size() != mesh.vertices.size()) {
    throw std::invalid_argument("quality: expected one number for each vertex, " +
                                std::to_string(mesh.vertices.size()) + ", found " + std::to_string(quality.size()));
  }
  AtomicFile file(path);
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) header += "comment " + comment + "\n";
  header += "element vertex " + std::to_string(mesh.vertices.size()) +
            "\nproperty float x\nproperty float y\nproperty float z\nproperty float quality\nelement face " +
            std::to_string(mesh.triangles.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  file.write(std::as_bytes(std::span(header)));
  Records records(file);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    records.add(mesh.vertices[v]);
    records.add(quality[v]);
    records.end_record();
  }
  for (const auto& triangle : mesh.triangles) {
    records.add(std::byte{3});
    records.add(triangle);
    records.end_record();
  }
  records.flush();
  file.commit();
}

}  // namespace isoweave
