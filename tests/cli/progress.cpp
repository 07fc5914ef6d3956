// Progress: what matters most comes first, and a line is never longer than its terminal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_progress_test {
namespace {

using Words = std::vector<std::string>;

const std::string kVolume = testing::kSanitized ? "generate:noise:48x48x96:uint8" : "generate:noise:96x96x96:uint8";
const Words kRun{"mesh", kVolume, "--iso", "127.5", "-o", "a.ply", "--slab", "8"};

// The lines that a run draws on a terminal of so many columns.
Words drawn_on(unsigned short columns) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) return {};
  const winsize size{24, columns, 0, 0};
  ::ioctl(terminal, TIOCSWINSZ, &size);
  program::Setup setup;
  setup.err_path = ::ptsname(terminal);
  const int held = ::open(setup.err_path.c_str(), O_RDWR | O_NOCTTY);  // or what was drawn is gone with the program
  const files::Folder folder;
  EXPECT_EQ(program::run(folder.path(), kRun, setup).code, 0);
  std::string text(1 << 16, '\0');
  const ssize_t bytes = ::read(terminal, text.data(), text.size());
  text.resize(bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  ::close(held);
  ::close(terminal);
  const std::string begin = "\r\x1b[K";
  Words lines;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    const std::string line = text.substr(from, text.find_first_of("\r\n", from) - from);
    if (line.starts_with('[')) lines.push_back(line);
  }
  return lines;
}

TEST(CliProgress, PercentIsThereOnEveryTerminal) {
  for (const unsigned short columns : std::initializer_list<unsigned short>{80, 50}) {
    const Words lines = drawn_on(columns);
    ASSERT_FALSE(lines.empty());
    for (const std::string& line : lines) {
      EXPECT_LT(line.size(), columns) << line;
      EXPECT_EQ(line.find(" %") > 12 && line.find(" %") < 18, true) << line;
      if (line.find("100 %") == std::string::npos && line.find(" 0 %") == std::string::npos) {
        EXPECT_EQ(line.find(" left, layer "), line.find(" left")) << "the time comes before the layers: " << line;
      }
    }
    EXPECT_NE(lines.back().find("[##########] 100 %, finishing the output"), std::string::npos) << lines.back();
  }
}

TEST(CliProgress, LinesElsewhereHaveAll) {
  const files::Folder folder;
  Words words = kRun;
  words.insert(words.end(), {"--progress", "always"});
  const std::string err = program::run(folder.path(), words).err;
  EXPECT_NE(err.find("isoweave: 100 %, finishing the output, layer 97 of 97, "), std::string::npos) << err;
  EXPECT_NE(err.find(" live triangles, "), std::string::npos) << err;
}

}  // namespace
}  // namespace isoweave::testing::cli_progress_test
