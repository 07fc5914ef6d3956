// OFF, text: counts, all vertices, all faces. The faces wait in a file of their own.
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_text.hpp"

namespace isoweave {
namespace {

// The header. The counts are known last: a comment takes the digits that they do not need, so that the header keeps its
// length.
std::string off_header(const MeshFileOptions& options, std::uint64_t vertices, std::uint64_t faces) {
  constexpr std::size_t kDigits = 40;
  const std::string counts = std::to_string(vertices) + " " + std::to_string(faces);
  std::string text = options.normals ? "NOFF\n" : "OFF\n";
  for (const std::string& comment : comment_lines(options)) text += "# " + comment + "\n";
  return text + "# padding " + std::string(kDigits + 1 - counts.size(), '.') + "\n" + counts + " 0\n";
}

class OffSink final : public MeshFileSink {
 public:
  OffSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, options), faces_(open_side("faces.part")) {
    const std::string header = off_header(options, 0, 0);
    if (!continued()) file().write(std::as_bytes(std::span(header)));
    bytes_ = file().size() + faces_.size();
  }

 private:
  void write_piece(const MeshPiece& piece) override {
    for (std::size_t n = 0; n < piece.vertices.size(); ++n) {
      const Point& vertex = piece.vertices[n];
      has_offset() ? print_numbers(vertex_text_, placed(vertex)) : print_numbers(vertex_text_, vertex);
      if (!piece.normals.empty()) print_point(vertex_text_, piece.normals[n]);
      end_line(vertex_text_, file());
    }
    for (const Triangle64& triangle : piece.triangles) {
      face_text_ += '3';
      for (const std::uint64_t index : triangle) {
        face_text_ += ' ';
        print(face_text_, index);
      }
      end_line(face_text_, faces_);
    }
  }

  template <class Coordinate>
  static void print_numbers(std::string& text, const std::array<Coordinate, 3>& point) {
    print(text, point[0]);
    text += ' ';
    print(text, point[1]);
    text += ' ';
    print(text, point[2]);
  }

  void end_line(std::string& text, OutputDescriptor& out) {
    text += '\n';
    if (text.size() >= kTextAtOnce) drain(text, out);
  }

  void drain(std::string& text, OutputDescriptor& out) {
    out.write(std::as_bytes(std::span(text)));
    bytes_ += text.size();
    text.clear();
  }

  void write_held_back() override {
    drain(vertex_text_, file());
    drain(face_text_, faces_);
  }

  void complete() override {
    write_held_back();
    file().append(faces_);
    const std::string header = off_header(options(), vertices(), triangles());
    file().overwrite(0, std::as_bytes(std::span(header)));
    check_written(bytes_, std::as_bytes(std::span(header)));
  }

  OutputDescriptor& faces_;
  std::string vertex_text_;
  std::string face_text_;
  std::uint64_t bytes_ = 0;  // of both files
};

}  // namespace

std::unique_ptr<MeshSink> open_off(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<OffSink>(target, options);
}

}  // namespace isoweave
