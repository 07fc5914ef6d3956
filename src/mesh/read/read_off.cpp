// OFF in text with its variants: counts, vertices, polygons. Normals behind the coordinates are read; colours and
// texture coordinates are not. Nor is the colour behind the corners of a face.
#include "mesh/read/mesh_leftovers.hpp"
#include "mesh/read/mesh_words.hpp"
#include "mesh/read/polygons.hpp"
#include "parallel/size.hpp"

namespace isoweave::mesh_io {
namespace {

// The facts that the letters before 'OFF' give.
struct OffKind {
  bool texture = false, colours = false, normals = false;
  bool other_space = false;  // four coordinates, or as many as the file says
  std::size_t length = 0;    // of the keyword; some programs put no blank behind it
};

// Small letters are taken for capitals, but 'nOFF' is of n coordinates and 'NOFF' has normals.
std::optional<OffKind> parse_keyword(std::string_view word) {
  constexpr std::string_view kOff = "off";
  const std::size_t at = lower_case(word.substr(0, 12)).find(kOff);
  if (at == std::string::npos) return std::nullopt;
  OffKind kind;
  kind.length = at + kOff.size();
  if (kind.length < word.size() && (word[kind.length] < '0' || word[kind.length] > '9')) return std::nullopt;
  std::string letters(word.substr(0, at));
  if (word[at] != 'O') {
    for (char& c : letters) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  kind.texture = letters.starts_with("ST");
  if (kind.texture) letters.erase(0, 2);
  for (const char letter : letters) {
    if (letter == 'C') {
      kind.colours = true;
    } else if (letter == 'N') {
      kind.normals = true;
    } else if (letter == '4' || letter == 'n') {
      kind.other_space = true;
    } else {
      return std::nullopt;
    }
  }
  return kind;
}

class OffReader {
 public:
  explicit OffReader(MeshInput& input) : input_(input), words_(input) {}

  TriangleMesh read() {
    read_header();
    points_.reserve(to_size(vertices_));
    mesh_.normals.reserve(has_normals_ ? to_size(vertices_) : 0);
    for (std::uint64_t n = 0; n < vertices_; ++n) read_vertex();
    for (std::uint64_t n = 0; n < faces_; ++n) read_face();
    if (words_.next_line()) {
      words_.fail("expected the end of the file after " + std::to_string(faces_) + " faces, found more");
    }
    check_indices(input_, mesh_.triangles, points_.size());
    words_.place().put_into(mesh_);
    set_vertices(mesh_, points_, words_.place().offset());
    polygons_.finish();
    leftovers_.note(mesh_);
    return std::move(mesh_);
  }

 private:
  void expect_line(const char* what) {
    if (!words_.next_line()) input_.fail(std::string("truncated: expected ") + what + ", found the end of the file");
  }

  // Reads the header, of which the keyword may be missing.
  void read_header() {
    expect_line("'OFF'");
    std::string_view look = words_.rest();
    const std::string_view word = take_word(look);
    if (const std::optional<OffKind> kind = parse_keyword(word)) take_keyword(*kind, word);
    vertices_ = count_of(words_.next(), "vertices");
    faces_ = count_of(words_.next(), "faces");
    words_.skip_line();
    check_size();
  }

  void take_keyword(const OffKind& kind, std::string_view word) {
    if (kind.other_space) words_.fail("expected vertices of three coordinates", word);
    words_.go_on_at(words_.rest().substr(words_.rest().find(word) + kind.length));
    std::string_view look = words_.rest();
    if (lower_case(take_word(look)) == "binary") words_.fail("is a binary OFF file, expected one in text");
    // MeshLab writes colours before normals, the definition puts them behind: with both, neither is sure.
    has_normals_ = kind.normals && !kind.colours;
    if (kind.normals && !has_normals_) leftovers_.not_kept("normals");
    if (kind.colours) leftovers_.not_kept("colours of vertices");
    if (kind.texture) leftovers_.not_kept("texture coordinates");
    says_more_ = kind.colours || kind.texture;
  }

  std::uint64_t count_of(std::string_view word, const char* what) const {
    const std::optional<std::uint64_t> count = parse_integer<std::uint64_t>(word);
    if (!count || *count > kMostVertices) words_.fail(std::string("expected the number of ") + what, word);
    return *count;
  }

  // A number takes two bytes, and the last line may lack its end.
  void check_size() const {
    const std::uint64_t least = vertices_ * (has_normals_ ? 12 : 6) + faces_ * 2;
    if (least <= input_.remaining() + 1) return;
    input_.fail("truncated: expected at least " + std::to_string(least) + " bytes of " + std::to_string(vertices_) +
                " vertices and " + std::to_string(faces_) + " faces, found " + std::to_string(input_.remaining()));
  }

  void read_vertex() {
    expect_line("a vertex");
    points_.push_back(words_.next_point());
    if (has_normals_) mesh_.normals.push_back(words_.next_normal());
    if (!says_more_ && !words_.next_on_line().empty())
      leftovers_.not_kept("numbers behind the coordinates of vertices");
    words_.skip_line();
  }

  void read_face() {
    expect_line("a face");
    const std::uint64_t corners = count_of(words_.next(), "corners");
    PolygonFan fan(mesh_.triangles);
    for (std::uint64_t n = 0; n < corners; ++n) {
      const std::string_view word = words_.next();
      const std::optional<std::uint32_t> index = parse_integer<std::uint32_t>(word);
      if (!index) words_.fail("expected the number of a vertex", word);
      fan.add(*index);
    }
    polygons_.end(corners);
    if (corners < 3) leftovers_.left_out(1, kFewCorners);
    if (!words_.next_on_line().empty()) leftovers_.not_kept("colours of faces");
    words_.skip_line();
  }

  MeshInput& input_;
  MeshWords words_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  bool has_normals_ = false;
  bool says_more_ = false;  // the keyword says what follows the coordinates
  TriangleMesh mesh_;
  Polygons polygons_{mesh_};
  std::vector<WidePoint> points_;
  MeshLeftovers leftovers_;
};

}  // namespace

bool is_off_keyword(std::string_view word) { return parse_keyword(word).has_value(); }

TriangleMesh read_off(MeshInput& input) { return OffReader(input).read(); }

}  // namespace isoweave::mesh_io
