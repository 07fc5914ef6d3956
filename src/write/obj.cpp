// Wavefront OBJ, text. Coordinates have the fewest digits that read back as the same float32.
#include <charconv>

#include "write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kTextAtOnce = std::size_t{1} << 16;

template <class Number>
void print(std::string& text, Number number) {
  char digits[32];
  const std::to_chars_result result = std::to_chars(digits, digits + sizeof(digits), number);
  text.append(digits, result.ptr);
}

class ObjSink final : public MeshFileSink {
 public:
  ObjSink(const std::string& path, const MeshFileOptions& options) : MeshFileSink(path, options) {
    text_bytes_ = file().size();
    if (continued()) return;
    for (const std::string& comment : options.comments) text_ += "# " + one_line(comment) + "\n";
  }

 private:
  void write_piece(std::span<const Point> vertices, std::span<const Point> normals,
                   std::span<const Triangle64> triangles) override {
    for (const Point& vertex : vertices) print_point("v", vertex);
    for (const Point& normal : normals) print_point("vn", normal);
    for (const Triangle64& triangle : triangles) print_face(triangle);
  }

  void print_point(const char* keyword, const Point& point) {
    text_ += keyword;
    for (const float coordinate : point) {
      text_ += ' ';
      print(text_, coordinate);
    }
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

  // There are no counts in the file; its length is checked against the text made.
  void complete() override {
    drain();
    check_written(text_bytes_, {});
  }

  std::string text_;
  std::uint64_t text_bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshSink> open_obj(const std::string& path, const MeshFileOptions& options) {
  return std::make_unique<ObjSink>(path, options);
}

}  // namespace isoweave
