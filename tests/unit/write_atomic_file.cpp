// A file is complete under its name, or there is no trace of it.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>

#include "files.hpp"
#include "files/atomic_file.hpp"
#include "files/atomic_folder.hpp"
#include "isoweave/error.hpp"
#include "isoweave/output_file.hpp"
#include "meshes.hpp"

namespace isoweave::testing::write_atomic_file_test {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

template <class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const CannotWrite& error) {
    return error.what();
  }
  return "nothing thrown";
}

// Files may not grow past a limit while this lives: a full disk, without a disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(OutputFile, IsCompleteOrAbsent) {
  const files::Folder folder;
  const std::string path = folder / "a.txt";
  files::write_bytes(path, "before");
  {
    OutputFile discarded(path);
    discarded.write(bytes_of("lost"));
  }
  EXPECT_EQ(files::read_bytes(path), "before");
  OutputFile file(path);
  file.write(bytes_of("af"));
  OutputFile moved = std::move(file);
  moved.write(bytes_of("ter"));
  EXPECT_EQ(files::read_bytes(path), "before");
  moved.commit();
  EXPECT_EQ(files::read_bytes(path), "after");
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.txt"});
  EXPECT_THROW(OutputFile(folder / "none/a.txt"), CannotWrite);
}

TEST(AtomicFile, AppearsOnCommitOnly) {
  const files::Folder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write(bytes_of("hello"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    // Where the file system has no files without names, there is one that says what it is.
    for (const std::string& temporary : folder.entries()) {
      EXPECT_TRUE(temporary.starts_with(".a.txt.") && temporary.ends_with(".partial")) << temporary;
    }
    file.commit();
  }
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(files::read_bytes(folder / "a.txt"), "hello");
}

TEST(AtomicFile, WithoutCommitNothingIsLeft) {
  const files::Folder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write(bytes_of(std::string(3 << 20, 'x')));
  }
  EXPECT_TRUE(folder.entries().empty());
}

TEST(AtomicFile, ReplacesAnOldFileOnCommitAndNotBefore) {
  const files::Folder folder;
  files::write_bytes(folder / "a.txt", "old");
  { AtomicFile(folder / "a.txt").write(bytes_of("lost")); }
  EXPECT_EQ(files::read_bytes(folder / "a.txt"), "old");
  AtomicFile file(folder / "a.txt");
  file.write(bytes_of("new"));
  file.commit();
  EXPECT_EQ(files::read_bytes(folder / "a.txt"), "new");
}

TEST(AtomicFile, OverwritesBufferedAndWrittenBytes) {
  const files::Folder folder;
  AtomicFile file(folder / "a.txt");
  file.write(bytes_of("count=0000;"));
  file.overwrite(6, bytes_of("0042"));                    // still in the buffer
  file.write(bytes_of(std::string((5 << 20) + 3, 'x')));  // larger than any buffer
  file.overwrite(6, bytes_of("7"));                       // long on the disk
  file.write(bytes_of("end"));                            // goes to the end all the same
  EXPECT_EQ(file.size(), 11U + (5U << 20U) + 3U + 3U);
  EXPECT_THROW(file.overwrite(file.size() - 1, bytes_of("xx")), std::invalid_argument);
  file.commit();
  EXPECT_EQ(files::read_bytes(folder / "a.txt"), "count=7042;" + std::string((5 << 20) + 3, 'x') + "end");
}

TEST(AtomicFile, AppendsAScratchFileThatHasNoName) {
  const files::Folder folder;
  const std::string block((3 << 20) + 1, 'y');
  AtomicFile file(folder / "a.txt");
  OutputDescriptor scratch(open_scratch(folder / "a.txt"), folder / "a.txt");
  EXPECT_LE(folder.entries().size(), 1U) << "no more than the temporary file of `file` has a name";
  scratch.write(bytes_of(block));
  scratch.write(bytes_of("tail"));
  file.write(bytes_of("head"));
  file.append(scratch);
  file.write(bytes_of("end"));
  file.commit();
  EXPECT_EQ(files::read_bytes(folder / "a.txt"), "head" + block + "tailend");
}

// A command-line user expects the mode of any new file, not the 0600 of mkstemp.
TEST(AtomicFile, ModeFollowsTheUmask) {
  const files::Folder folder;
  const mode_t before = ::umask(027);
  AtomicFile file(folder / "a.txt");
  ::umask(before);
  file.commit();
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(AtomicFile, LongNamesAreNotMadeTooLongByTheTemporaryName) {
  const files::Folder folder;
  const std::string name(255, 'n');
  AtomicFile file(folder / name);
  file.commit();
  EXPECT_TRUE(std::filesystem::exists(folder / name));
}

// A link to a file on another disk must not be replaced by the file.
TEST(AtomicFile, WritesThroughASymbolicLink) {
  const files::Folder folder;
  std::filesystem::create_directory(folder / "store");
  files::write_bytes(folder / "store/real.txt", "old");
  std::filesystem::create_symlink("store/real.txt", folder / "link.txt");
  AtomicFile file(folder / "link.txt");
  file.write(bytes_of("new"));
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(files::read_bytes(folder / "store/real.txt"), "new");
}

TEST(AtomicFile, OpeningFailsAtOnceWithThePathAndTheReason) {
  const files::Folder folder;
  std::filesystem::create_directory(folder / "sub");
  const auto open = [](const std::string& path) { return message_of([&] { AtomicFile file(path); }); };
  EXPECT_NE(open("").find("empty"), std::string::npos);
  EXPECT_EQ(open(folder / "sub"), (folder / "sub") + ": is a folder, expected a file name");
  EXPECT_EQ(open(folder / "sub/"), (folder / "sub/") + ": is a folder, expected a file name");
  EXPECT_NE(open(folder / "missing/a.txt").find("missing/a.txt: cannot create a file in"), std::string::npos);
  EXPECT_NE(open(folder / "missing/a.txt").find("No such file or directory"), std::string::npos);
  files::write_bytes(folder / "file", "");
  EXPECT_NE(open(folder / "file/a.txt").find("Not a directory"), std::string::npos);
  const PartFile part{folder / "a.part", std::nullopt};
  for (const std::string& path : {folder / "sub", folder / "missing/a.txt", folder / "file/a.txt"}) {
    EXPECT_EQ(message_of([&] { AtomicFile file(path, part); }), open(path));
  }
  EXPECT_EQ(folder.entries().size(), 2U);
}

// As when a process is killed while it puts counts into the header of a mesh that is complete otherwise.
TEST(OutputDescriptor, APartThatWasOverwrittenGoesOnFromItsMark) {
  const files::Folder folder;
  const std::string text = "header: 0000, then what was written before the mark";
  const PartMark mark{text.size(), add_to_crc(0, bytes_of(text))};
  {
    OutputDescriptor file = open_part({folder / "a", std::nullopt});
    file.write(bytes_of(text + " and behind it"));
    file.overwrite(8, bytes_of("1234"));
    file.overwrite(10, bytes_of("56"));
    file.overwrite(text.size() - 2, bytes_of("across it"));
    file.flush();
  }
  EXPECT_NE(files::read_bytes(folder / "a").substr(0, text.size()), text);
  files::write_bytes(folder / "a.before.new", "of a process that was killed");
  OutputDescriptor file = open_part({folder / "a", mark});
  EXPECT_EQ(files::read_bytes(folder / "a"), text);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.before"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.before.new"));
  file.write(bytes_of("."));
  file.flush();
  EXPECT_EQ(files::read_bytes(folder / "a"), text + ".");
}

TEST(OutputDescriptor, WhatWasOverwrittenAndIsDamagedIsRefused) {
  const files::Folder folder;
  files::write_bytes(folder / "a", "text");
  for (const std::string& saved : {std::string("short"), std::string(8, '\0') + std::string(8, '\x7f') + "x"}) {
    files::write_bytes(folder / "a.before", saved);
    EXPECT_THROW(open_part({folder / "a", PartMark{4, add_to_crc(0, bytes_of("text"))}}), BadInput);
  }
}

// The checksum of the file follows all that is done to it: appended in buffers and past them, joined, overwritten.
TEST(OutputDescriptor, KeepsTheChecksumOfTheWholeFile) {
  const files::Folder folder;
  std::mt19937 random(3);
  const auto some = [&](std::size_t size) {
    std::string text(size, ' ');
    for (char& c : text) c = static_cast<char>(random());
    return text;
  };
  OutputDescriptor file = open_part({folder / "a", std::nullopt});
  OutputDescriptor side = open_part({folder / "b", std::nullopt});
  file.write(bytes_of(some(1000)));
  file.write(bytes_of(some(3 << 20)));
  side.write(bytes_of(some(100)));
  side.write(bytes_of(some(2 << 20)));
  file.append(side);
  file.write(bytes_of(some(77)));
  for (const std::uint64_t at : {0U, 999U, 1U << 20U}) file.overwrite(at, bytes_of(some(50)));
  file.overwrite(file.size() - 9, bytes_of(some(9)));
  file.flush();
  EXPECT_EQ(file.checksum(), add_to_crc(0, bytes_of(files::read_bytes(folder / "a"))));
  file.verify();
  std::fstream(folder / "a", std::ios::in | std::ios::out | std::ios::binary).seekp(12345) << "disturbed";
  EXPECT_EQ(message_of([&] { file.verify(); }), (folder / "a") + ": holds other bytes than were written to it");
  EXPECT_EQ(message_of([&] { file.close(); }), (folder / "a") + ": holds other bytes than were written to it");
}

// A rename onto a device would replace the device: as root, /dev/null would become a mesh.
TEST(AtomicFile, DevicesAreNotReplaced) {
  EXPECT_EQ(message_of([] { AtomicFile file("/dev/null"); }), "/dev/null: exists and is not a regular file");
}

TEST(AtomicFile, ReadOnlyFolderAndFileAreErrors) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const files::Folder folder;
  files::write_bytes(folder / "a.txt", "");
  ::chmod((folder / "a.txt").c_str(), 0444);
  EXPECT_THROW(AtomicFile file(folder / "a.txt"), CannotWrite);
  ::chmod(folder.path().c_str(), 0555);
  EXPECT_THROW(AtomicFile file(folder / "b.txt"), CannotWrite);
  ::chmod(folder.path().c_str(), 0755);
}

TEST(AtomicFile, FailingWriteSaysWhyAndLeavesNothing) {
  const files::Folder folder;
  {
    const FileSizeLimit limit(1 << 16);
    const std::string message = message_of([&] {
      AtomicFile file(folder / "a.txt");
      file.write(bytes_of(std::string(1 << 17, 'x')));
      file.commit();
    });
    EXPECT_NE(message.find("a.txt: cannot write: File too large"), std::string::npos) << message;
  }
  EXPECT_TRUE(folder.entries().empty());
}

// Every way a mesh writer can run out of room: in the vertices, in the spooled faces, in the copy at the end.
TEST(AtomicFile, MeshWritersLeaveNothingWhenTheDiskIsFull) {
  const TriangleMesh mesh = meshes::grid(300);
  const std::vector<std::array<std::uint64_t, 3>> triangles(mesh.triangles.size(), {0, 1, 302});
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.off", "a.glb", "a.vtp", "a.precomputed"}) {
    for (const rlim_t limit_bytes : {1U << 10U, 1200U << 10U, 1900U << 10U}) {
      const files::Folder folder;
      const FileSizeLimit limit(limit_bytes);
      EXPECT_THROW(
          {
            const auto sink = open_mesh_file(folder / name);
            sink->append({.vertices = mesh.vertices, .triangles = triangles});
            sink->finish();
          },
          CannotWrite)
          << name << " with " << limit_bytes;
      EXPECT_TRUE(folder.entries().empty()) << name << " with " << limit_bytes;
    }
  }
}

TEST(AtomicFile, MeshWritersLeaveNothingWithoutFinish) {
  const files::Folder folder;
  for (const std::string name : {"a.ply", "a.stl", "a.obj", "a.off", "a.glb", "a.vtp", "a.3mf", "a.precomputed"}) {
    const auto sink = open_mesh_file(folder / name);
    sink->append({.vertices = meshes::cube().vertices});
  }
  EXPECT_TRUE(folder.entries().empty());
}

// After a failed write the file has a hole or a tail; to go on and finish would hide it.
TEST(AtomicFile, AMeshCannotBeFinishedAfterAFailedWrite) {
  const files::Folder folder;
  const TriangleMesh mesh = meshes::grid(300);
  const auto sink = open_mesh_file(folder / "a.ply");
  {
    const FileSizeLimit limit(1 << 10);
    EXPECT_THROW(sink->append({.vertices = mesh.vertices}), CannotWrite);
  }
  EXPECT_THROW(sink->finish(), std::logic_error);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

// A link is followed to a folder that is there, and to one that is not.
TEST(AtomicFolder, IsWrittenThroughASymbolicLink) {
  const files::Folder folder;
  std::filesystem::create_directories(folder / "store/empty");
  for (const std::string name : {"empty", "new"}) {
    const std::string link = folder / (name + ".precomputed");
    std::filesystem::create_directory_symlink("store/" + name, link);
    AtomicFolder out(link + "/");
    out.write_file("info", bytes_of("after"));
    out.commit();
    EXPECT_TRUE(std::filesystem::is_symlink(link)) << name;
    EXPECT_EQ(files::read_bytes(folder / ("store/" + name + "/info")), "after");
  }
}

}  // namespace
}  // namespace isoweave::testing::write_atomic_file_test
