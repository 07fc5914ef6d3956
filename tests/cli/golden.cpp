// The program prints the digests that the rows of golden/digests.txt say.
#include <gtest/gtest.h>

#include <algorithm>

#include "golden/rows.hpp"
#include "program.hpp"

namespace isoweave::testing::cli_golden_test {
namespace {

// After each "digest " of what the program says.
std::vector<std::string> printed_digests(const std::string& text) {
  const std::string word = "digest ";
  std::vector<std::string> digests;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    digests.push_back(text.substr(at + word.size(), 16));
  }
  return digests;
}

// A row's mesh is a file of its name, for rows that simplify it.
TEST(CliGolden, DigestsAreThoseOfTheRows) {
  const files::Folder folder;
  for (const golden::Row& row : golden::read_rows(ISOWEAVE_GOLDEN_FILE)) {
    std::vector<std::string> arguments = row.words;
    if (arguments.at(0) == "simplify") arguments.at(1) += ".ply";
    arguments.insert(arguments.end(), {"-o", row.name + ".ply"});
    const program::Result result = program::run(folder.path(), arguments);
    ASSERT_EQ(result.code, 0) << row.name << ": " << result.err;
    EXPECT_EQ(printed_digests(result.out + result.err), row.digests) << row.name;
  }
}

}  // namespace
}  // namespace isoweave::testing::cli_golden_test
