// Wavefront OBJ, text. Coordinates have the fewest digits that read back as the same float32, or float64 where there is
// an offset.
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_text.hpp"

namespace isoweave {
namespace {

class ObjSink final : public MeshFileSink {
 public:
  ObjSink(const MeshTarget& target, const MeshFileOptions& options) : MeshFileSink(target, options) {
    text_bytes_ = file().size();
    if (continued()) return;
    for (const std::string& comment : comment_lines(options)) text_ += "# " + comment + "\n";
  }

 private:
  void write_piece(const MeshPiece& piece) override {
    for (const Point& vertex : piece.vertices) has_offset() ? print_line("v", placed(vertex)) : print_line("v", vertex);
    for (const Point& normal : piece.normals) print_line("vn", normal);
    for (const Triangle64& triangle : piece.triangles) print_face(triangle);
  }

  template <class Coordinate>
  void print_line(const char* keyword, const std::array<Coordinate, 3>& point) {
    text_ += keyword;
    print_point(text_, point);
    end_line();
  }

  void print_face(const Triangle64& triangle) {
    text_ += 'f';
    for (const std::uint64_t index : triangle) {
      text_ += ' ';
      print(text_, index + 1);
      if (options().normals) {
        text_ += "//";
        print(text_, index + 1);
      }
    }
    end_line();
  }

  void end_line() {
    text_ += '\n';
    if (text_.size() >= kTextAtOnce) drain();
  }

  void write_held_back() override { drain(); }

  void drain() {
    file().write(std::as_bytes(std::span(text_)));
    text_bytes_ += text_.size();
    text_.clear();
  }

  // Writes the rest. The file has no counts, so its length is checked against the text made.
  void complete() override {
    drain();
    check_written(text_bytes_, {});
  }

  std::string text_;
  std::uint64_t text_bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshSink> open_obj(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<ObjSink>(target, options);
}

}  // namespace isoweave
