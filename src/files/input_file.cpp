#include "files/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"
#include "system/descriptor.hpp"
#include "system/durable_file.hpp"
#include "system/file_facts.hpp"

namespace isoweave {

void bad_input(std::string_view path, std::string_view message) {
  throw BadInput(printable(path) + ": " + printable(message));
}

void bad_input(std::string_view path, std::string_view expected, std::string_view found) {
  bad_input(path, "expected " + std::string(expected) + ", found " + std::string(found));
}

std::string InputFile::head(std::size_t limit) const {
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(limit, size_)), '\0');
  text.resize(read_at(0, std::as_writable_bytes(std::span(text))));
  return text;
}

std::string InputFile::size_text() const {
  const std::string bytes = std::to_string(size_);
  return knows_size() ? bytes : "at most " + bytes + " once inflated";
}

DescriptorFile::DescriptorFile(int descriptor, std::string path, std::uint64_t size, bool unnamed)
    : InputFile(std::move(path), size), descriptor_(descriptor), unnamed_(unnamed) {
  system::expect_in_order(descriptor_);
}

DescriptorFile::~DescriptorFile() { system::close_descriptor(descriptor_); }

void DescriptorFile::forget(std::uint64_t offset, std::uint64_t bytes) const {
  system::expect_no_more(descriptor_, offset, bytes);
}

std::size_t DescriptorFile::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  if (offset >= size()) return 0;
  std::size_t done = 0;
  while (done < out.size()) {
    const std::int64_t got = system::read_at(descriptor_, offset + done, out.subspan(done));
    if (got < 0) bad_input(path(), std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string DescriptorFile::system_path() const { return unnamed_ ? system::path_of(descriptor_) : path(); }

FilePtr open_file(const std::string& path, std::string_view wanted) {
  system::Descriptor descriptor(system::open_descriptor(path, system::Opening::kReadAtOnce));
  if (descriptor.get() < 0) bad_input(path, std::string("cannot be opened: ") + std::strerror(errno));
  const std::optional<system::FileStatus> status = system::status_of(descriptor.get());
  if (!status) bad_input(path, std::string("cannot be examined: ") + std::strerror(errno));
  const bool regular = status->kind == system::FileStatus::Kind::kRegular;
  if (regular && status->bytes > 0) {
    return std::make_shared<DescriptorFile>(descriptor.release(), path, status->bytes, false);
  }
  if (status->kind == system::FileStatus::Kind::kFolder) bad_input(path, wanted, "a directory");
  if (!regular) bad_input(path, "a regular file", "a device, pipe or socket");
  bad_input(path, wanted, "an empty file");
}

std::string beside(const std::string& header_path, const std::string& name) {
  // operator/ keeps an absolute name as it is.
  return (std::filesystem::path(header_path).parent_path() / name).string();
}

}  // namespace isoweave
