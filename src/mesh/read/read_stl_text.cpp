// STL in text. Words may stand on any lines, and keywords are in any case. The words between 'facet' and 'outer', a
// normal, are skipped.
#include "mesh/read/mesh_words.hpp"
#include "mesh/read/welder.hpp"

namespace isoweave::mesh_io {
namespace {

class StlText {
 public:
  explicit StlText(MeshInput& input) : input_(input), words_(input) {}

  TriangleMesh read() {
    std::string keyword = next_keyword();
    do {
      check(keyword, "solid");
      read_solid();
      keyword = next_keyword();
    } while (!keyword.empty());
    place_.put_into(mesh_);
    weld_corners();
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
    const std::string_view line = words_.rest();
    for (std::string_view look = line; !look.empty();) {
      const std::string_view from_here = look;
      std::string_view after = look;
      const bool facet = lower_case(take_word(after)) == "facet";
      look = after;
      if (!facet || lower_case(take_word(after)) != "normal") continue;
      place_.take_comment(line.substr(0, line.size() - from_here.size()));
      return words_.go_on_at(from_here);
    }
    place_.take_comment(line);
    words_.skip_line();
  }

  void read_solid() {
    skip_name();
    for (;;) {
      const std::string keyword = next_keyword();
      // Some programs leave out the blank before the name.
      if (keyword.starts_with("endsolid")) break;
      if (keyword != "facet") check(keyword, keyword.empty() ? "endsolid" : "facet");
      read_facet();
    }
    words_.skip_line();
  }

  // Skips a normal, whose numbers may be missing, or be none.
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
    if (corners_.size() > kMostVertices - 3) input_.fail("has more than 4294967295 corners, expected a binary file");
    const auto first = static_cast<std::uint32_t>(corners_.size());
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      corners_.push_back(words_.next_point());
    }
    expect("endloop");
    expect("endfacet");
    mesh_.triangles.push_back({first, first + 1, first + 2});
  }

  // Joins corners whose coordinates are equal after rounding.
  void weld_corners() {
    mesh_.offset = offset_for(corners_, mesh_.triangles, place_.offset(), mesh_.notes);
    Welder welder(mesh_.vertices);
    for (auto& triangle : mesh_.triangles) {
      for (std::uint32_t& corner : triangle) corner = welder.number(relative_point(corners_[corner], mesh_.offset));
    }
  }

  MeshInput& input_;
  MeshWords words_;
  MeshPlace place_;
  std::vector<WidePoint> corners_;  // three for each triangle
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_stl_ascii(MeshInput& input) { return StlText(input).read(); }

}  // namespace isoweave::mesh_io
