// Meshes of other programs, put together by hand.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "files/zip_archive.hpp"
#include "isoweave/mesh.hpp"
#include "mesh_file_helpers.hpp"

namespace isoweave::foreign {

using mesh_files::failure;
using mesh_files::parse;
using mesh_files::raw;

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline bool has_note(const TriangleMesh& mesh, const std::string& part) {
  for (const std::string& note : mesh.notes) {
    if (contains(note, part)) return true;
  }
  return false;
}

// Whatever is cut off or changed: a mesh that can be used without further checks, or BadInput.
inline void expect_damage_is_safe(const std::string& name, const std::string& bytes) {
  const files::Folder folder;
  std::size_t refused = 0;
  const auto read = [&](const std::string& damaged) {
    files::write_bytes(folder / name, damaged);
    try {
      const TriangleMesh mesh = read_mesh(folder / name);
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle) ASSERT_LT(index, mesh.vertices.size());
      }
      for (const Point& p : mesh.vertices)
        ASSERT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
      ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
      ASSERT_TRUE(mesh.values.empty() || mesh.values.size() == mesh.vertices.size());
    } catch (const BadInput& error) {
      EXPECT_FALSE(contains(error.what(), "\n")) << error.what();
      ++refused;
    }
  };
  for (std::size_t length = 0; length < bytes.size(); ++length) read(bytes.substr(0, length));
  std::mt19937_64 random(20260201);
  const std::vector<std::string> words{"-1", "0",         "99999999999999999999", "nan", "1e999", "\n", "<", "\"",
                                       "[",  "4294967295"};
  for (int round = 0; round < 1500; ++round) {
    std::string damaged = bytes;
    damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    if (round % 2 == 0) damaged.replace(random() % damaged.size(), random() % 4, words[random() % words.size()]);
    read(damaged);
  }
  EXPECT_GT(refused, bytes.size() / 4) << "the damage must reach the checks";
}

// Stored entries, by name and text.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string archive;
  std::vector<ZipEntry> directory;
  const auto append = [&](const std::vector<std::byte>& bytes) {
    archive.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  for (const auto& [name, text] : entries) {
    directory.push_back({name, false, zip_crc(0, text), text.size(), text.size(), archive.size()});
    append(zip_header(directory.back()));
    archive += text;
  }
  append(zip_directory(directory, archive.size()));
  return archive;
}

}  // namespace isoweave::foreign
