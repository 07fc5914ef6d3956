// neuroglancer's multi-resolution meshes with one object, or with many: a folder with `info` and one shard, `0.shard`.
#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "files/atomic_folder.hpp"
#include "files/waiting_bytes.hpp"
#include "isoweave/error.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/multilod_info.hpp"
#include "mesh/write/object_shard.hpp"
#include "mesh/write/packed_object.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

ByteReader reader_of(OutputDescriptor& file) {
  return [&file](std::uint64_t first, std::span<std::byte> bytes) { file.read_back(first, bytes); };
}

void write_text(AtomicFolder& folder, const std::string& name, const std::string& text) {
  folder.write_file(name, std::as_bytes(std::span(text)));
}

class PackedPrecomputedLevels final : public JoinedFile {
 public:
  PackedPrecomputedLevels(const std::string& path, const std::vector<MeshFileOptions>& levels)
      : JoinedFile(path, levels, JoinedForm::kWide) {}

  void check_room(const JoinedMesh&, std::uint64_t, std::uint64_t) override {}  // fragments are checked one by one

 private:
  // The levels before the first one of which nothing is left, as nothing is left of those behind it.
  std::vector<WaitingLevel> waiting() {
    std::vector<WaitingLevel> levels;
    for (JoinedMesh& mesh : meshes()) {
      if (mesh.triangles() == 0) break;
      levels.push_back({mesh.vertices(), mesh.triangles(), reader_of(mesh.positions()), reader_of(mesh.faces())});
    }
    return levels;
  }

  void write() override {
    for (std::string& line : multilod_unit_notes(path(), options().unit)) note(std::move(line));
    const std::vector<WaitingLevel> levels = waiting();
    std::vector<std::uint64_t> triangles;
    triangles.reserve(levels.size());
    for (const WaitingLevel& level : levels) triangles.push_back(level.triangles);
    const NodeGrid grid(corners(), triangles);
    AtomicFolder folder(path());
    AtomicFile file(folder.file("0.shard"));
    ObjectShard shard(file, 0);
    const std::vector<std::byte> manifest =
        pack_object(path(), grid, levels, [&](std::span<const std::byte> bytes) { shard.write(bytes); });
    if (!levels.empty()) note(multilod_rounding(path(), options().unit, grid.error(0), levels.size() - 1));
    shard.add(options().segment, manifest);
    shard.finish();
    file.commit();
    write_text(folder, "info", multilod_info(options(), 0, ""));
    folder.commit();
  }
};

// An object that was packed. Its fragments and its manifest wait in a file, one behind the other.
struct PackedObject {
  MeshObject object;
  std::uint64_t first = 0, fragments = 0, manifest = 0;  // place, and bytes
};

class PackedPrecomputedObjects final : public MeshObjects {
 public:
  PackedPrecomputedObjects(const std::string& path, const MeshFileOptions& options)
      : path_(path),
        options_(options),
        pieces_(folder_of(without_slashes(path)), path),
        packed_(folder_of(without_slashes(path)), path) {
    AtomicFolder::check_free(path);
  }

  std::unique_ptr<MeshSink> begin(const MeshObject& object) override;
  void finish() override;
  std::vector<std::string> notes() const override {
    std::vector<std::string> lines = multilod_unit_notes(path_, options_.unit);
    if (!objects_.empty()) lines.push_back(multilod_rounding(path_, options_.unit, error_, 0));
    return lines;
  }

  const std::string& path() const { return path_; }
  WaitingFile& pieces() { return pieces_; }

  // Keeps an object whose mesh is complete. Objects are packed one at a time.
  void add(const MeshObject& object, const Bounds& bounds, const WaitingLevel& level) {
    const std::scoped_lock lock(mutex_);
    const std::array<Point, 2> corners{bounds.low, bounds.high};
    const NodeGrid grid(corners, std::span(&level.triangles, 1));
    PackedObject packed{object, packed_.size(), 0, 0};
    const std::vector<std::byte> manifest =
        pack_object(path_, grid, std::span(&level, 1), [&](std::span<const std::byte> bytes) {
          packed_.append(bytes);
          packed.fragments += bytes.size();
        });
    packed_.append(manifest);
    packed.manifest = manifest.size();
    error_ = std::max(error_, grid.error(0));
    objects_.push_back(std::move(packed));
  }

 private:
  void sort_objects(unsigned bits);
  void copy(std::uint64_t first, std::uint64_t count, ObjectShard& shard);
  void write_shard(AtomicFile& file, unsigned bits);
  std::string path_;
  MeshFileOptions options_;
  WaitingFile pieces_;  // of meshes that are not complete
  WaitingFile packed_;
  std::mutex mutex_;
  std::vector<PackedObject> objects_;
  double error_ = 0;
};

// The mesh of an object until it is complete.
class ObjectSink final : public MeshFileSink {
 public:
  ObjectSink(PackedPrecomputedObjects& file, const MeshObject& object, const MeshFileOptions& options)
      : MeshFileSink({file.path(), MeshTarget::Kind::kJoined}, options),
        file_(file),
        object_(object),
        positions_(file.pieces()),
        faces_(file.pieces()) {}

 private:
  void write_piece(const MeshPiece& piece) override {
    bounds_.add(piece.vertices);
    positions_.write(std::as_bytes(piece.vertices));
    faces_.write(std::as_bytes(piece.triangles));
  }

  // An object of which nothing is left is none.
  void complete() override {
    if (triangles() == 0) return;
    const auto reader = [](const WaitingBytes& bytes) -> ByteReader {
      return [&bytes](std::uint64_t first, std::span<std::byte> out) { bytes.read_back(first, out); };
    };
    file_.add(object_, bounds_, {vertices(), triangles(), reader(positions_), reader(faces_)});
  }

  PackedPrecomputedObjects& file_;
  MeshObject object_;
  Bounds bounds_;
  WaitingBytes positions_, faces_;
};

std::unique_ptr<MeshSink> PackedPrecomputedObjects::begin(const MeshObject& object) {
  if (object.segment == 0) throw CannotWrite(path_ + ": expected a number of 1 or more for the object, found 0");
  return std::make_unique<ObjectSink>(*this, object, options_);
}

// In the order of the shard, whatever the order in which they came.
void PackedPrecomputedObjects::sort_objects(unsigned bits) {
  const auto key = [&](const PackedObject& packed) {
    return std::pair(ObjectShard::minishard_of(packed.object.segment, bits), packed.object.segment);
  };
  std::ranges::sort(objects_, {}, key);
  const auto same = std::ranges::adjacent_find(objects_, {}, key);
  if (same == objects_.end()) return;
  throw std::invalid_argument(path_ + ": expected each object once, found " + std::to_string(same->object.segment) +
                              " twice");
}

void PackedPrecomputedObjects::copy(std::uint64_t first, std::uint64_t count, ObjectShard& shard) {
  constexpr std::uint64_t kAtOnce = 1 << 20;
  std::vector<std::byte> bytes;
  for (std::uint64_t done = 0; done < count; done += bytes.size()) {
    bytes.resize(to_size(std::min(kAtOnce, count - done)));
    packed_.read_back(first + done, bytes);
    shard.write(bytes);
  }
}

void PackedPrecomputedObjects::write_shard(AtomicFile& file, unsigned bits) {
  ObjectShard shard(file, bits);
  for (const PackedObject& packed : objects_) {
    copy(packed.first, packed.fragments, shard);
    std::vector<std::byte> manifest(to_size(packed.manifest));
    packed_.read_back(packed.first + packed.fragments, manifest);
    shard.add(packed.object.segment, manifest);
  }
  shard.finish();
}

// The text with numbers, names and sizes of the objects, which neuroglancer lists.
std::string properties_of(std::span<const PackedObject> objects) {
  using Json = nlohmann::ordered_json;
  Json ids = Json::array(), names = Json::array(), samples = Json::array();
  for (const PackedObject& packed : objects) {
    ids.push_back(std::to_string(packed.object.segment));
    names.push_back(packed.object.name);
    samples.push_back(static_cast<float>(packed.object.samples));
  }
  Json properties = Json::array();
  properties.push_back(Json{{"id", "name"}, {"type", "label"}, {"values", std::move(names)}});
  properties.push_back(
      Json{{"id", "samples"}, {"type", "number"}, {"data_type", "float32"}, {"values", std::move(samples)}});
  Json info{{"@type", "neuroglancer_segment_properties"}};
  info["inline"]["ids"] = std::move(ids);
  info["inline"]["properties"] = std::move(properties);
  return info.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void PackedPrecomputedObjects::finish() {
  const std::scoped_lock lock(mutex_);
  const unsigned bits = ObjectShard::bits_for(objects_.size());
  sort_objects(bits);
  AtomicFolder folder(path_);
  AtomicFile file(folder.file("0.shard"));
  write_shard(file, bits);
  file.commit();
  folder.make_folder("properties");
  std::ranges::sort(objects_, {}, [](const PackedObject& packed) { return packed.object.segment; });
  write_text(folder, "properties/info", properties_of(objects_));
  write_text(folder, "info", multilod_info(options_, bits, "properties"));
  folder.commit();
}

}  // namespace

std::unique_ptr<JoinedFile> open_packed_precomputed_levels(const std::string& path,
                                                           std::span<const MeshFileOptions> levels) {
  AtomicFolder::check_free(path);
  std::vector<MeshFileOptions> plain;
  for (const MeshFileOptions& options : levels) plain.push_back(without_normals(options));
  return std::make_unique<PackedPrecomputedLevels>(path, plain);
}

std::unique_ptr<MeshObjects> open_packed_precomputed_objects(const std::string& path, const MeshFileOptions& options) {
  return std::make_unique<PackedPrecomputedObjects>(path, without_normals(options));
}

}  // namespace isoweave
