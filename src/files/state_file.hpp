// The file that the state of a run is saved in, or a message with a part of one: fields one after another,
// little-endian, and a CRC-32 of all that stands before it. Anyone may have written it: what is read is checked before
// it is used.
//
// A class with a state has members serialize(StateWriter&) and serialize(StateReader&), or one template for both where
// nothing has to be checked.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "files/atomic_file.hpp"
#include "parallel/size.hpp"

namespace isoweave {

inline constexpr std::size_t kStateBlock = 4096;  // values that are written or read together

static_assert(std::endian::native == std::endian::little, "a state has the bytes of numbers as they lie in memory");

class StateWriter {
 public:
  // Writes into memory: take() has the bytes.
  StateWriter() = default;

  // The file appears on commit(). Throws CannotWrite, as all members do.
  explicit StateWriter(const std::string& path) : file_(std::in_place, path) {}

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

  // Values without their number, which are made one by one: get(n) gives the n-th.
  template <class Get>
  void each(std::size_t count, const Get& get) {
    using T = decltype(get(std::size_t{0}));
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> block(std::min(count, kStateBlock));
    for (std::size_t first = 0; first < count; first += block.size()) {
      block.resize(std::min(block.size(), count - first));
      for (std::size_t n = 0; n < block.size(); ++n) block[n] = get(first + n);
      put(std::as_bytes(std::span(block)));
    }
  }

  void commit();

  // Ends what is written into memory.
  std::vector<std::byte> take();

 private:
  void put(std::span<const std::byte> bytes);
  void write(std::span<const std::byte> bytes);

  std::optional<AtomicFile> file_;
  std::vector<std::byte> bytes_;  // without a file
  std::uint32_t crc_ = 0;
};

class StateReader {
 public:
  // Reads the whole file once, for its CRC. Throws BadInput, as all members do. `kind`: the noun for such a file in
  // messages.
  explicit StateReader(const std::string& path, const char* kind = "saved state");

  // Reads bytes in memory. `name` stands for the file in messages.
  StateReader(std::vector<std::byte> bytes, const std::string& name, const char* kind);

  template <class T>
  void value(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    get(std::as_writable_bytes(std::span(&value, 1)));
  }

  template <class List>
  void list(List& list) {
    list.resize(count(sizeof(*list.data())));
    get(std::as_writable_bytes(std::span(list.data(), list.size())));
  }

  // The number of values that follow, of so many bytes each at least.
  std::size_t count(std::uint64_t bytes_each) {
    std::uint64_t count = 0;
    value(count);
    require_left(count, bytes_each);
    return to_size(count);
  }

  // Values without their number: put(n, value) takes the n-th.
  template <class T, class Put>
  void each(std::size_t count, const Put& put) {
    static_assert(std::is_trivially_copyable_v<T>);
    require_left(count, sizeof(T));
    std::vector<T> block(std::min(count, kStateBlock));
    for (std::size_t first = 0; first < count; first += block.size()) {
      block.resize(std::min(block.size(), count - first));
      get(std::as_writable_bytes(std::span(block)));
      for (std::size_t n = 0; n < block.size(); ++n) put(first + n, block[n]);
    }
  }

  // Refuses the state unless a condition holds. expected: what the state should have there.
  void require(bool holds, const char* expected) const {
    if (!holds) refuse(expected);
  }

  // Refuses a state with more in it than has been read.
  void require_end() const { require(left_ == 0, "its end"); }

  const std::string& path() const { return path_; }

 private:
  void check_crc();
  void read(std::span<std::byte> bytes);
  void rewind();
  void require_left(std::uint64_t count, std::uint64_t bytes_each) const;
  [[noreturn]] void refuse(const char* expected) const;
  void get(std::span<std::byte> bytes);

  std::string path_;
  const char* kind_;
  std::ifstream file_;
  std::vector<std::byte> bytes_;  // without a file
  std::size_t at_ = 0;            // bytes read of them
  std::uint64_t left_ = 0;        // bytes of fields not read yet
};

}  // namespace isoweave
