// A glTF 2.0 file, binary or text: its scene, and the numbers that it refers to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_place.hpp"

namespace isoweave::mesh_io {

using GltfValue = nlohmann::json;

class GltfFile {
 public:
  // Fails when the file is not complete or no glTF 2, and when it names a file that is missing or must not be named.
  explicit GltfFile(MeshInput& input);

  // Bytes of the file and of those that it names.
  std::uint64_t size() const { return size_; }

  const GltfValue& scene() const { return scene_; }

  // An element of one of the lists of the file ("meshes", "nodes", ...), by a number found elsewhere in the file.
  const GltfValue& element(const char* list, const GltfValue& number) const;

  // A whole number that is not negative.
  std::uint64_t whole(const GltfValue& value, std::string_view what) const;

  // Vectors of three numbers, and quaternions, each number of 8, 16 or 32 bits.
  std::vector<WidePoint> vectors(const GltfValue& accessor) { return rows<3>(accessor, "VEC3"); }
  std::vector<std::array<double, 4>> quaternions(const GltfValue& accessor) { return rows<4>(accessor, "VEC4"); }
  std::vector<std::uint32_t> indices(const GltfValue& accessor);

 private:
  // Numbers as stored, tightly or with other data between them.
  struct Stored {
    std::vector<std::byte> bytes;
    std::uint64_t count = 0, stride = 0;
    std::uint64_t component = 0;  // glTF's number of its type
    bool normalized = false;
  };

  template <std::size_t kCount>
  std::vector<std::array<double, kCount>> rows(const GltfValue& accessor, std::string_view type);
  std::string read_binary();
  std::string read_text();
  std::uint32_t next_u32();
  void take_buffers();
  Stored stored(const GltfValue& accessor, std::string_view type, std::size_t components);
  std::vector<std::byte> bytes_of(std::uint64_t buffer, std::uint64_t offset, std::uint64_t bytes);
  const std::vector<std::byte>* unpacked_view(const GltfValue& number);

  MeshInput& input_;
  GltfValue scene_;
  // A buffer: bytes out of the scene's text, or of a file from a place on.
  struct Buffer {
    std::vector<std::byte> bytes;
    FilePtr file;
    std::uint64_t begin = 0, size = 0;
  };

  Buffer buffer_of(const std::string& uri);

  std::uint64_t size_;
  std::uint64_t binary_ = 0, binary_bytes_ = 0;  // where the chunk of data is; 0: there is none
  std::vector<Buffer> buffers_;
  std::map<std::uint64_t, std::vector<std::byte>> unpacked_;  // views that are packed in the file
  std::uint64_t unpacked_bytes_ = 0;
};

}  // namespace isoweave::mesh_io
