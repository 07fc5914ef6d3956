#include "files/whole_input.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"
#include "system/descriptor.hpp"
#include "system/durable_file.hpp"
#include "system/file_facts.hpp"
#include "system/process.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kBlockBytes = 1 << 20;
using system::Descriptor;

[[noreturn]] void cannot_keep(const std::string& folder, const std::string& path) {
  throw CannotWrite(printable(folder) + ": cannot keep what comes out of " + printable(path) + ": " +
                    std::strerror(errno) + " (TMPDIR names another folder)");
}

using Source = std::function<std::size_t(std::span<std::byte> out)>;

std::string temporary_folder() {
  std::error_code error;
  const std::filesystem::path found = std::filesystem::temp_directory_path(error);
  return error ? "/tmp" : found.string();
}

// A file with all bytes that `next` gives. An empty answer ends it.
FilePtr keep(const Source& next, const std::string& path, std::string_view wanted = kVolumeFile) {
  const std::string folder = temporary_folder();
  Descriptor file(system::create_private(folder));
  if (file.get() < 0) cannot_keep(folder, path);
  std::vector<std::byte> buffer(kBlockBytes);
  std::uint64_t size = 0;
  for (std::size_t got = next(buffer); got > 0; got = next(buffer)) {
    if (!system::write_all(file.get(), std::span(buffer).first(got))) cannot_keep(folder, path);
    size += got;
  }
  if (size == 0) bad_input(path, wanted, "nothing before the end of the pipe");
  return std::make_shared<DescriptorFile>(file.release(), path, size, true);
}

std::size_t read_pipe(int pipe, const std::string& path, std::span<std::byte> out) {
  const std::int64_t got = system::read_once(pipe, out);
  if (got < 0) bad_input(path, std::string("cannot be read: ") + std::strerror(errno));
  return static_cast<std::size_t>(got);
}

// The content of pipes, kept as long as anybody holds it.
class KeptPipes {
 public:
  FilePtr get(const system::FileStatus& pipe, const std::function<FilePtr()>& read) {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const InputFile>& kept = files_[{pipe.device, pipe.file}];
    FilePtr file = kept.lock();
    if (!file) kept = file = read();
    return file;
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::weak_ptr<const InputFile>> files_;
};

}  // namespace

FilePtr open_input_file(const std::string& path, std::string_view wanted) {
  const std::optional<system::FileStatus> status = system::status_of(path);
  if (!status || status->kind != system::FileStatus::Kind::kPipe) return open_file(path, wanted);
  static KeptPipes kept;
  return kept.get(*status, [&] {
    // A socket cannot be opened by its name.
    const bool standard = path == kStandardInput;
    const Descriptor pipe(standard ? system::duplicate_standard_input()
                                   : system::open_descriptor(path, system::Opening::kRead));
    if (pipe.get() < 0) bad_input(path, std::string("cannot be opened: ") + std::strerror(errno));
    return keep([&](std::span<std::byte> out) { return read_pipe(pipe.get(), path, out); }, path, wanted);
  });
}

FilePtr jumping_file(const FilePtr& file) {
  if (file->jumps()) return file;
  std::uint64_t position = 0;
  return keep(
      [&](std::span<std::byte> out) {
        const std::size_t got = file->read_at(position, out);
        position += got;
        return got;
      },
      file->path());
}

FileName::FileName(const InputFile& file) : text_(file.system_path()), given_(file.system_path() != file.path()) {
  if (!given_) return;
  std::random_device random;
  const std::string name =
      temporary_folder() + "/isoweave." + std::to_string(system::process_number()) + "." + std::to_string(random());
  if (!system::link_path(text_, name)) {
    bad_input(file.path(), std::string("cannot be given a name in a folder: ") + std::strerror(errno) +
                               " (TMPDIR names another one; or save it to a file first)");
  }
  text_ = name;
}

FileName::~FileName() {
  if (given_) system::remove_name(text_);
}

}  // namespace isoweave
