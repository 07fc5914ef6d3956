// Open files, pipes and sockets by the system's numbers for them. A function that fails returns -1 or false and leaves
// the reason in errno. Calls that a signal interrupts are made again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace isoweave::system {

enum class Opening : std::uint8_t {
  kRead,
  kReadAtOnce,  // without waiting for the writer of a pipe
  kWrite,       // for reading, too, as all that follow
  kWriteOrCreate,
  kCreateNew,    // fails where there is such a name
  kCreateEmpty,  // in place of what the file held
};

// Not inherited by programs that the process starts. The umask takes its share of the rights of a new file.
int open_descriptor(const std::string& path, Opening how);

// Another descriptor of the same open file.
int duplicate(int descriptor);
int duplicate_standard_input();

bool close_descriptor(int descriptor);

// The functions that read return the number of bytes read, 0 at the end.
std::int64_t read_at(int descriptor, std::uint64_t offset, std::span<std::byte> out);
std::int64_t read_once(int descriptor, std::span<std::byte> out);  // of a pipe; waits where its opener wished not to

// Writes all bytes. ENOSPC means that nothing more can be written.
bool write_all(int descriptor, std::span<const std::byte> bytes);
bool write_all_at(int descriptor, std::uint64_t offset, std::span<const std::byte> bytes);

// Advice, on which nothing depends but speed: the file is read from its beginning to its end; these bytes are not
// needed again soon.
void expect_in_order(int descriptor);
void expect_no_more(int descriptor, std::uint64_t offset, std::uint64_t bytes);

// Closes the descriptor unless it is released.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close_descriptor(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&&) = delete;

  int get() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

}  // namespace isoweave::system
