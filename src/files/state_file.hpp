// The file that the state of a run is saved in: fields one after another, in the machine's own byte order, and a CRC-32
// of all that stands before it.
//
// A class with a state has a member template `serialize(archive)`. It names the fields once, for a StateWriter to write
// and for a StateReader to read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <type_traits>

#include "files/atomic_file.hpp"
#include "parallel/size.hpp"

namespace isoweave {

class StateWriter {
 public:
  static constexpr bool kReads = false;

  // The file appears on commit(). Throws CannotWrite, as all members do.
  explicit StateWriter(const std::string& path) : file_(path) {}

  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::as_bytes(std::span(&value, 1)));
  }

  // A string, vector or Array.
  template <class List>
  void list(const List& list) {
    value(static_cast<std::uint64_t>(list.size()));
    put(std::as_bytes(std::span(list.data(), list.size())));
  }

  void commit();

 private:
  void put(std::span<const std::byte> bytes);

  AtomicFile file_;
  std::uint32_t crc_ = 0;
};

class StateReader {
 public:
  static constexpr bool kReads = true;

  // Reads the whole file once, for its CRC. Throws BadInput, as all members do.
  explicit StateReader(const std::string& path);

  template <class T>
  void value(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    get(std::as_writable_bytes(std::span(&value, 1)));
  }

  template <class List>
  void list(List& list) {
    std::uint64_t size = 0;
    value(size);
    require(size, sizeof(*list.data()));
    list.resize(to_size(size));
    get(std::as_writable_bytes(std::span(list.data(), list.size())));
  }

  const std::string& path() const { return path_; }

 private:
  void check_crc();
  void require(std::uint64_t count, std::uint64_t bytes_each) const;
  void get(std::span<std::byte> bytes);

  std::string path_;
  std::ifstream file_;
  std::uint64_t left_ = 0;  // bytes of fields not read yet
};

}  // namespace isoweave
