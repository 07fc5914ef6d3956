// Meshes that are cut off after a mark and go on from it, in every format.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "meshes.hpp"

namespace isoweave::testing::write_mesh_marks_test {
namespace {

// A sheet in two pieces.
class Pieces {
 public:
  Pieces() {
    for (const Point& p : mesh_.vertices) {
      normals_.push_back({std::sin(p[0]), std::cos(p[0]), 0});
      values_.push_back(p[0] - p[1]);
    }
    for (const auto& t : mesh_.triangles) triangles_.push_back({t[0], t[1], t[2]});
  }

  void first(MeshSink& sink) const {
    sink.append({.vertices = std::span(mesh_.vertices).first(400),
                 .normals = std::span(normals_).first(400),
                 .values = std::span(values_).first(400)});
    sink.append({.vertices = std::span(mesh_.vertices).subspan(400, 200),
                 .normals = std::span(normals_).subspan(400, 200),
                 .values = std::span(values_).subspan(400, 200),
                 .triangles = std::span(triangles_).first(900)});
  }
  void second(MeshSink& sink) const {
    sink.append({.vertices = std::span(mesh_.vertices).subspan(600),
                 .normals = std::span(normals_).subspan(600),
                 .values = std::span(values_).subspan(600),
                 .triangles = std::span(triangles_).subspan(900)});
  }

 private:
  TriangleMesh mesh_ = meshes::grid(30);
  std::vector<Point> normals_;
  std::vector<float> values_;
  std::vector<Triangle64> triangles_;
};

// All bytes of a file, or of the files in a folder.
std::string all_bytes(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return files::read_bytes(path);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path)) names.push_back(entry.path());
  std::sort(names.begin(), names.end());
  std::string bytes;
  for (const std::string& name : names) bytes += name.substr(path.size()) + files::read_bytes(name);
  return bytes;
}

MeshFileOptions options_for(const files::Folder& parts, const std::string& name, bool compress) {
  MeshFileOptions options;
  options.normals = true;
  options.values = name == "a.ply" || name == "a.vtp";
  options.comments = {"a test"};
  options.unit = "mm";
  options.parts = parts.path();
  options.compress = compress;
  return options;
}

void expect_same_file(const std::string& name, bool compress, const std::array<double, 3>& offset = {0, 0, 0}) {
  const Pieces pieces;
  const files::Folder whole, cut, parts;
  MeshFileOptions options = options_for(parts, name, compress);
  options.offset = offset;
  options.parts.clear();
  {
    const auto sink = open_mesh_file(whole / name, options);
    pieces.first(*sink);
    pieces.second(*sink);
    sink->finish();
  }
  options = options_for(parts, name, compress);
  options.offset = offset;
  {
    const auto sink = open_mesh_file(cut / name, options);
    pieces.first(*sink);
    options.mark = sink->mark();
    pieces.second(*sink);  // comes to nothing
  }
  EXPECT_TRUE(cut.entries().empty());
  // A process may end once more, and again when the mesh has its name and the state is not gone yet. A folder that is
  // there is not replaced.
  const int last = name == "a.precomputed" ? 1 : 2;
  for (int again = 0; again <= last; ++again) {
    const std::string finished = again == 2 ? all_bytes(cut / name) : "";
    const auto sink = open_mesh_file(cut / name, options);
    EXPECT_EQ(sink->mark(), options.mark);
    pieces.second(*sink);
    const bool untouched = again < 2 || all_bytes(cut / name) == finished;
    EXPECT_TRUE(untouched) << name << " is what it was until the other has its name";
    if (again > 0) sink->finish();
    if (again == last) sink->forget_marks();
  }
  EXPECT_TRUE(parts.entries().empty());
  EXPECT_EQ(cut.entries().size(), 1U);
  if (name == "a.3mf") {  // blocks of packed text end at the mark
    EXPECT_EQ(check_mesh(read_mesh(cut / name)).digest, check_mesh(read_mesh(whole / name)).digest);
  } else {
    EXPECT_TRUE(all_bytes(cut / name) == all_bytes(whole / name)) << name;
  }
}

TEST(MeshMarks, EveryFormatGoesOnToTheSameFile) {
  for (const char* name : meshes::kFileNames) expect_same_file(name, false);
  expect_same_file("a.precomputed", false);
}

TEST(MeshMarks, SoItDoesFarFromTheOrigin) {
  for (const char* name : meshes::kFileNames) expect_same_file(name, false, {5e6, 0.1, 0});
  expect_same_file("a.precomputed", false, {5e6, 0.1, 0});
}

TEST(MeshMarks, PackedFormatsToo) {
#ifdef ISOWEAVE_HAS_MESHOPTIMIZER
  expect_same_file("a.glb", true);
#endif
#ifdef ISOWEAVE_HAS_DRACO
  expect_same_file("a.precomputed", true);
#endif
}

TEST(MeshMarks, OthersAreRefused) {
  const files::Folder folder;
  MeshFileOptions options;
  options.parts = folder.path();
  std::string mark;
  mark = open_mesh_file(folder / "a.obj", options)->mark();
  files::write_bytes(folder / "faces.part", "");
  for (const std::string& text : {mark + " x", std::string("1 2"), std::string("x")}) {
    options.mark = text;
    EXPECT_THROW(open_mesh_file(folder / "a.obj", options), std::invalid_argument) << text;
  }
  options.mark = mark;
  EXPECT_THROW(open_mesh_file(folder / "a.glb", options), std::invalid_argument) << "it has no bounds";
  EXPECT_THROW(open_mesh_file(folder / "a.stl", options), std::invalid_argument) << "it has no second file";
  options.parts.clear();
  EXPECT_THROW(open_mesh_file(folder / "a.obj", options), std::invalid_argument) << "no folder";
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_marks_test
