#include "pipeline/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "files/atomic_file.hpp"
#include "files/file_lock.hpp"
#include "files/input_file.hpp"
#include "isoweave/error.hpp"
#include "system/descriptor.hpp"
#include "system/durable_file.hpp"
#include "system/file_facts.hpp"
#include "system/process.hpp"

namespace isoweave {
namespace {

constexpr std::array<std::uint64_t, 2> kNumbers{0, 1};
constexpr std::string_view kFormat = "isoweave state 15\n";  // the number changes with fields and rules

constexpr std::uint64_t kMostMarks = 1000;  // the most marks of a state file, which anyone may have written

struct Header {
  std::uint64_t number = 0;
  RunIdentity identity;
  Checkpoint checkpoint;

  template <class Archive>
  void serialize(Archive& archive) {
    archive.value(number);
    archive.list(identity.volume);
    archive.list(identity.options);
    archive.list(checkpoint.note);
    std::uint64_t marks = checkpoint.marks.size();
    archive.value(marks);
    checkpoint.marks.resize(std::min<std::uint64_t>(marks, kMostMarks));
    for (std::string& mark : checkpoint.marks) archive.list(mark);
    archive.value(checkpoint.layer);
    archive.value(checkpoint.layers);
  }
};

std::string state_path(const std::string& folder, std::uint64_t number) {
  return folder + "/state-" + std::to_string(number % 2);
}

Header read_header(StateReader& reader) {
  std::string format;
  reader.list(format);
  constexpr const char* kExpected = "a state saved by isoweave " ISOWEAVE_VERSION;
  if (format != kFormat) bad_input(reader.path(), kExpected, "another file");
  std::string version;
  reader.list(version);
  if (version != ISOWEAVE_VERSION) bad_input(reader.path(), kExpected, "one of version " + version);
  Header header;
  header.serialize(reader);
  header.checkpoint.path = reader.path();
  return header;
}

// The newest whole state of a folder, or nothing. Then `why` names a state that is not whole, if there is one.
std::optional<Header> newest_state(const std::string& folder, std::string& why) {
  std::optional<Header> newest;
  for (const std::uint64_t number : kNumbers) {
    const std::string path = state_path(folder, number);
    if (!std::filesystem::exists(path)) continue;
    try {
      StateReader reader(path);
      const Header header = read_header(reader);
      if (!newest || header.number > newest->number) newest = header;
    } catch (const BadInput& error) {
      why = error.what();
    }
  }
  return newest;
}

void require_same(const std::string& path, const char* what, const std::string& saved, const std::string& now) {
  if (saved == now) return;
  bad_input(path, std::string("the ") + what + " has changed: expected " + saved + ", found " + now);
}

}  // namespace

namespace {

constexpr int kLockAttempts = 100;

[[noreturn]] void refuse_lock(const std::string& folder, int fd) {
  std::array<char, 20> digits{};
  const std::int64_t got = system::read_at(fd, 0, std::as_writable_bytes(std::span(digits)));
  const std::string process(digits.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
  const bool known = !process.empty() && process.find_first_not_of("0123456789") == std::string::npos;
  throw CannotWrite(folder + ": expected a folder of saved states that nobody uses, found a run that goes on in it" +
                    (known ? ", process " + process : ""));
}

// A locked descriptor, or -1 when the file has gone meanwhile.
int open_lock(const std::string& folder, const std::string& path) {
  system::Descriptor fd(system::open_descriptor(path, system::Opening::kWriteOrCreate));
  if (fd.get() < 0) {
    throw CannotWrite(folder + ": cannot be locked against other processes: " + std::generic_category().message(errno));
  }
  if (!try_lock(fd.get(), path)) refuse_lock(folder, fd.get());
  return keeps_name(fd.get(), path) ? fd.release() : -1;
}

}  // namespace

CheckpointLock::CheckpointLock(const std::string& folder) : path_(folder + "/lock") {
  for (int attempt = 0; fd_ < 0 && attempt < kLockAttempts; ++attempt) fd_ = open_lock(folder, path_);
  if (fd_ < 0) throw CannotWrite(folder + ": cannot be locked against other processes: they take turns at it");
  const std::string process = std::to_string(system::process_number());
  // Only a process that is refused reads the number, for its message.
  [[maybe_unused]] const bool told =
      system::cut_off(fd_, 0) && system::write_all(fd_, std::as_bytes(std::span(process)));
}

CheckpointLock::CheckpointLock(CheckpointLock&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

CheckpointLock::~CheckpointLock() {
  if (fd_ < 0) return;
  system::remove_name(path_);
  system::close_descriptor(fd_);
}

Checkpoint read_checkpoint(const std::string& folder) {
  std::string why = folder + ": expected a folder with a saved state, found none";
  const std::optional<Header> newest = newest_state(folder, why);
  if (!newest) throw BadInput(why);
  return newest->checkpoint;
}

StateReader open_state(const Checkpoint& checkpoint, const RunIdentity& identity) {
  StateReader reader(checkpoint.path);
  const Header header = read_header(reader);
  require_same(checkpoint.path, "volume", header.identity.volume, identity.volume);
  require_same(checkpoint.path, "task", header.identity.options, identity.options);
  return reader;
}

namespace {

// Whether a name is that of a state that was being renamed when its process was killed.
bool is_unfinished_state(const std::string& name) { return name.starts_with(".state-") && name.ends_with(".partial"); }

void remove_unfinished_states(const std::string& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (is_unfinished_state(entry.path().filename().string())) left.push_back(entry.path());
  }
  for (const std::filesystem::path& path : left) std::filesystem::remove(path, ignored);
}

}  // namespace

CheckpointFolder::CheckpointFolder(const std::string& folder) : folder_(folder) {
  remove_unfinished_states(folder_);
  std::string why;
  if (const std::optional<Header> newest = newest_state(folder_, why)) number_ = newest->number;
}

std::unique_ptr<StateWriter> CheckpointFolder::begin_state(const Checkpoint& checkpoint, const RunIdentity& identity) {
  ++number_;
  auto writer = std::make_unique<StateWriter>(state_path(folder_, number_));
  writer->list(kFormat);
  writer->list(std::string_view(ISOWEAVE_VERSION));
  Header{number_, identity, checkpoint}.serialize(*writer);
  return writer;
}

void CheckpointFolder::clear() {
  for (const std::uint64_t number : kNumbers) std::remove(state_path(folder_, number).c_str());
}

}  // namespace isoweave
