// neuroglancer's legacy meshes: a folder with `info`, the list of an object's fragments, and one fragment: a count,
// positions in nanometres, indices. Positions and indices wait in files of their own.
#include <nlohmann/json.hpp>

#include "files/atomic_folder.hpp"
#include "files/length_units.hpp"
#include "isoweave/error.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"

namespace isoweave {
namespace {

class PrecomputedSink final : public MeshFileSink {
 public:
  PrecomputedSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, without_normals(options)),
        nanometres_(unit_in(unit_or_usual(options.unit), "nm").value_or(1)),
        places_(path(), options, nanometres_),
        positions_(open_side("positions.part")),
        faces_(open_side("faces.part")) {
    if (continued() && has_offset()) places_.load(saved_state(1));
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> lines = places_.notes();
    if (options().unit.empty()) lines.push_back(path() + ": the unit is not said, coordinates were taken for mm");
    return lines;
  }

 private:
  std::vector<std::uint64_t> state() const override {
    return has_offset() ? places_.state() : std::vector<std::uint64_t>{};
  }

  void write_piece(const MeshPiece& piece) override {
    check_count_fits(path(), "vertices", this->vertices(), piece.vertices.size());
    write_records(positions_, records_, piece.vertices.size(), 12,
                  [&](std::byte*& out, std::size_t n) { store_point(out, scaled(piece.vertices[n])); });
    write_records(faces_, records_, piece.triangles.size(), 12,
                  [&](std::byte*& out, std::size_t n) { store_indices(out, piece.triangles[n]); });
  }

  Point scaled(const Point& point) {
    if (has_offset()) return places_.point(point);
    Point result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] = static_cast<float>(double{point[axis]} * nanometres_);
    }
    return result;
  }

  void complete() override {
    const std::string object = std::to_string(options().segment);
    AtomicFolder folder(path());
    const auto write_json = [&](const std::string& name, const nlohmann::ordered_json& json) {
      const std::string text = json.dump() + "\n";
      folder.write_file(name, std::as_bytes(std::span(text)));
    };
    write_json("info", {{"@type", "neuroglancer_legacy_mesh"}});
    write_json(object + ":0", {{"fragments", {object + ":0:0"}}});
    write_fragment(folder.file(object + ":0:0"));
    folder.commit();
  }

  void write_fragment(const std::string& name) {
    AtomicFile fragment(name);
    std::array<std::byte, 4> count{};
    std::byte* out = count.data();
    store_u32(out, static_cast<std::uint32_t>(vertices()));
    fragment.write(count);
    fragment.append(positions_);
    fragment.append(faces_);
    if (fragment.size() != 4 + vertices() * 12 + triangles() * 12) {
      throw CannotWrite(path() + ": its counts and its size differ");
    }
    fragment.commit();
  }

  double nanometres_;  // of a unit
  RoundedPlaces places_;
  OutputDescriptor& positions_;
  OutputDescriptor& faces_;
  std::vector<std::byte> records_;
};

}  // namespace

std::unique_ptr<MeshSink> open_precomputed(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<PrecomputedSink>(target, options);
}

}  // namespace isoweave
