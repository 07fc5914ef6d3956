// Mesh files from the bytes of a test.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/mesh.hpp"

namespace isoweave::mesh_files {

inline TriangleMesh parse(const std::string& name, const std::string& bytes) {
  const files::Folder folder;
  files::write_bytes(folder / name, bytes);
  return read_mesh(folder / name);
}

// The message of the BadInput, without the path it begins with.
inline std::string failure(const std::string& name, const std::string& bytes) {
  const files::Folder folder;
  files::write_bytes(folder / name, bytes);
  try {
    read_mesh(folder / name);
  } catch (const BadInput& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with((folder / name) + ": ")) << message;
    return message.substr((folder / name).size() + 2);
  }
  return "nothing thrown";
}

template <class Number>
std::string raw(Number number, bool big_endian = false) {
  std::string bytes(sizeof(number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(number));
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

inline std::string raw_point(float x, float y, float z) { return raw(x) + raw(y) + raw(z); }

// The text with every line feed replaced.
inline std::string with_line_ends(const std::string& text, const std::string& end) {
  std::string all;
  for (const char c : text) all += c == '\n' ? end : std::string(1, c);
  return all;
}

}  // namespace isoweave::mesh_files
