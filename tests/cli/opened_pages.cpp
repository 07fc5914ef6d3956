// Pages that are opened in the browser of the desktop: what it is given, and what is said where there is none.
#ifdef ISOWEAVE_HAS_VIEWER
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "page_files.hpp"
#include "program.hpp"

namespace isoweave::testing::cli_opened_pages_test {
namespace {

using pages::json_in;
using program::Result;
using program::run;

// A folder with a program in it that is called to open pages.
class CliOpenedPage : public ::testing::Test {
 protected:
  CliOpenedPage() {
    const Result made =
        run(folder_.path(), {"mesh", "generate:gyroid:16x16x16", "--iso", "0", "-o", "out.ply", "--quiet"});
    EXPECT_EQ(made.code, 0) << made.err;
    std::filesystem::create_directory(folder_ / "bin");
  }

  Result view(const std::string& opener) const {
    program::Setup setup;
    setup.environment = {"PATH=" + (folder_ / "bin") + ":/usr/bin:/bin"};
    if (opener.empty()) {
      setup.environment = {"PATH=" + (folder_ / "bin")};
    } else {
      files::write_bytes(folder_ / "bin/xdg-open", "#!/bin/sh\n" + opener);
      std::filesystem::permissions(folder_ / "bin/xdg-open", std::filesystem::perms::owner_all);
    }
    return run(folder_.path(), {"view", "out.ply", "--open"}, setup);
  }

  void expect_page() const {
    EXPECT_EQ(json_in(files::read_bytes(folder_ / "out.ply.html"), "report")["output"], "out.ply");
    std::filesystem::remove(folder_ / "out.ply.html");
  }

  const files::Folder folder_;
};

TEST_F(CliOpenedPage, IsGivenToTheDesktop) {
  const Result result = view("echo chatter >&2; echo chatter; printf '%s' \"$#:$1\" > opened\n");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err + result.out, "");
  EXPECT_EQ(files::read_bytes(folder_ / "opened"),
            "1:" + (std::filesystem::canonical(folder_.path()) / "out.ply.html").string());
  expect_page();
}

TEST_F(CliOpenedPage, StaysWhereNothingOpensIt) {
  program::expect_failed(view("echo chatter >&2; exit 3\n"), 4,
                         "out.ply.html: is written, but xdg-open could not show it: open it in a browser");
  expect_page();
  std::filesystem::remove(folder_ / "bin/xdg-open");
  program::expect_failed(view(""), 4,
                         "out.ply.html: is written, but there is no xdg-open to open it with: open it in a browser");
  expect_page();
}

// Some openers are the browser.
TEST_F(CliOpenedPage, IsNotWaitedFor) {
  EXPECT_EQ(view("echo $$ > running\nexec sleep 600\n").code, 0);
  const pid_t process = std::stoi(files::read_bytes(folder_ / "running"));
  EXPECT_EQ(::kill(process, SIGTERM), 0) << "it goes on";
  expect_page();
}

}  // namespace
}  // namespace isoweave::testing::cli_opened_pages_test
#endif
