#include "files/whole_input.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

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

#include "files/printable.hpp"
#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;
constexpr const char* kStandardInput = "/dev/stdin";

// Closes the descriptor unless it is released.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

[[noreturn]] void cannot_keep(const std::string& folder, const std::string& path) {
  throw CannotWrite(printable(folder) + ": cannot keep what comes out of " + printable(path) + ": " +
                    std::strerror(errno) + " (TMPDIR names another folder)");
}

// A new file that no folder lists, so that the system frees it however the process ends.
int create_unnamed(const std::string& folder, const std::string& path) {
  constexpr mode_t kOwner = 0600;
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kOwner);
  if (file >= 0) return file;
  // Some file systems have no such files; there the name is taken away at once.
  std::string name = folder + "/isoweave.XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named < 0) cannot_keep(folder, path);
  ::unlink(name.c_str());
  return named;
}

using Source = std::function<std::size_t(std::span<std::byte> out)>;

std::string temporary_folder() {
  std::error_code error;
  const std::filesystem::path found = std::filesystem::temp_directory_path(error);
  return error ? "/tmp" : found.string();
}

// All bytes that `next` gives, as a file. It gives none at the end.
FilePtr keep(const Source& next, const std::string& path, std::string_view wanted = kVolumeFile) {
  const std::string folder = temporary_folder();
  Descriptor file(create_unnamed(folder, path));
  std::vector<std::byte> buffer(kBufferBytes);
  std::uint64_t size = 0;
  for (std::size_t got = next(buffer); got > 0; got = next(buffer)) {
    for (std::size_t done = 0; done < got;) {
      const ssize_t written = ::write(file.get(), buffer.data() + done, got - done);
      if (written < 0 && errno != EINTR) cannot_keep(folder, path);
      if (written > 0) done += static_cast<std::size_t>(written);
    }
    size += got;
  }
  if (size == 0) bad_input(path, wanted, "nothing before the end of the pipe");
  return std::make_shared<DescriptorFile>(file.release(), path, size, true);
}

std::size_t read_pipe(int pipe, const std::string& path, std::span<std::byte> out) {
  while (true) {
    const ssize_t got = ::read(pipe, out.data(), out.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno == EAGAIN) {
      // Whoever opened the pipe asked not to wait in it.
      pollfd wanted{pipe, POLLIN, 0};
      ::poll(&wanted, 1, -1);
    } else if (errno != EINTR) {
      bad_input(path, std::string("cannot be read: ") + std::strerror(errno));
    }
  }
}

// What came out of pipes, for as long as somebody holds it. Pipes are told apart by device and inode.
class KeptPipes {
 public:
  FilePtr get(const struct stat& status, const std::function<FilePtr()>& read) {
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const InputFile>& kept = files_[{status.st_dev, status.st_ino}];
    FilePtr file = kept.lock();
    if (!file) kept = file = read();
    return file;
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<dev_t, ino_t>, std::weak_ptr<const InputFile>> files_;
};

bool is_pipe(const struct stat& status) { return S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode); }

}  // namespace

FilePtr open_input_file(const std::string& path, std::string_view wanted) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !is_pipe(status)) return open_file(path, wanted);
  static KeptPipes kept;
  return kept.get(status, [&] {
    // A socket cannot be opened by its name.
    const bool standard = path == kStandardInput;
    const Descriptor pipe(standard ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                                   : ::open(path.c_str(), O_RDONLY | O_CLOEXEC));
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
      temporary_folder() + "/isoweave." + std::to_string(::getpid()) + "." + std::to_string(random());
  if (::linkat(AT_FDCWD, text_.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0) {
    bad_input(file.path(), std::string("cannot be given a name in a folder: ") + std::strerror(errno) +
                               " (TMPDIR names another one; or save it to a file first)");
  }
  text_ = name;
}

FileName::~FileName() {
  if (given_) ::unlink(text_.c_str());
}

}  // namespace isoweave
