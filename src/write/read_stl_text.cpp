// STL in text. Words may stand on any lines, keywords are in any case; what follows 'facet' up to 'outer', a normal, is
// not looked at.
#include "write/mesh_words.hpp"
#include "write/welder.hpp"

namespace isoweave::mesh_io {
namespace {

class StlText {
 public:
  explicit StlText(MeshInput& input) : input_(input), words_(input), welder_(mesh_.vertices) {}

  TriangleMesh read() {
    std::string keyword = next_keyword();
    do {
      check(keyword, "solid");
      read_solid();
      keyword = next_keyword();
    } while (!keyword.empty());
    return std::move(mesh_);
  }

 private:
  // Empty at the end of the file. Some write "end facet" for "endfacet".
  std::string next_keyword() {
    std::string keyword = lower_case(words_.next());
    if (keyword == "end") keyword += lower_case(words_.next());
    return keyword;
  }

  void expect(std::string_view keyword) { check(next_keyword(), keyword); }

  void check(const std::string& found, std::string_view keyword) const {
    if (found.empty()) {
      input_.fail("truncated: expected '" + std::string(keyword) + "', found the end of the file");
    }
    if (found != keyword) words_.fail("expected '" + std::string(keyword) + "'", found);
  }

  // A name ends with its line, or where the first facet begins, in files of one line.
  void skip_name() {
    for (std::string_view look = words_.rest(); !look.empty();) {
      const std::string_view from_here = look;
      std::string_view after = look;
      const bool facet = lower_case(take_word(after)) == "facet";
      look = after;
      if (facet && lower_case(take_word(after)) == "normal") return words_.go_on_at(from_here);
    }
    words_.skip_line();
  }

  void read_solid() {
    skip_name();
    for (;;) {
      const std::string keyword = next_keyword();
      // Some leave out the blank before the name.
      if (keyword.starts_with("endsolid")) break;
      if (keyword != "facet") check(keyword, keyword.empty() ? "endsolid" : "facet");
      read_facet();
    }
    words_.skip_line();
  }

  // Its numbers may be missing, or be none.
  void skip_normal() {
    std::string keyword = next_keyword();
    while (!keyword.empty() && !is_keyword(keyword)) keyword = next_keyword();
    check(keyword, "outer");
  }

  static bool is_keyword(std::string_view word) {
    for (const char* known : {"solid", "facet", "outer", "loop", "vertex", "endloop", "endfacet", "endsolid"}) {
      if (word == known) return true;
    }
    return false;
  }

  void read_facet() {
    skip_normal();
    expect("loop");
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
      expect("vertex");
      corner = welder_.number(words_.next_point());
      if (corner == Welder::kMostPoints) input_.fail("has more than 4294967295 different corners");
    }
    expect("endloop");
    expect("endfacet");
    mesh_.triangles.push_back(corners);
  }

  MeshInput& input_;
  MeshWords words_;
  TriangleMesh mesh_;
  Welder welder_;
};

}  // namespace

TriangleMesh read_stl_ascii(MeshInput& input) { return StlText(input).read(); }

}  // namespace isoweave::mesh_io
