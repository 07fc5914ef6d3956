// What texts of others look like in messages.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "files/quoted.hpp"
#include "isoweave/printable.hpp"

namespace isoweave::testing::volume_printable_test {
namespace {

TEST(Printable, KeepsTextAndReplacesWhatHidesOrDrives) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", ""},
      {"plain ~text", "plain ~text"},
      {"\xc3\xa4\xe2\x82\xac\xf0\x9f\xa6\xb4", "\xc3\xa4\xe2\x82\xac\xf0\x9f\xa6\xb4"},  // umlaut, euro, bone
      {"\xc2\xa0", "\xc2\xa0"},                                                          // the first behind C1
      {"a\tb\nc\rd", "a?b?c?d"},
      {"\x1b[31m", "?[31m"},
      {"\x7f", "?"},
      {"\xc2\x80\xc2\x9b\xc2\x9f", "???"},              // C1
      {"\x80\x9b", "??"},                               // C1 as bytes
      {"\xe2\x80\xaa\xe2\x80\xae", "??"},               // U+202A, U+202E
      {"\xe2\x81\xa6\xe2\x81\xa9", "??"},               // U+2066, U+2069
      {"\xe2\x80\x8b\xe2\x80\x8f\xef\xbb\xbf", "???"},  // zero width, a mark of direction, a byte order mark
      {"\xe2\x80\xa8\xe2\x80\xa9", "??"},               // ends of a line and of a paragraph
      {"\xf3\xa0\x81\x81", "?"},                        // a tag
      {"\xc0\xaf", "??"},                               // longer than it need be
      {"\xe0\x80\xaf", "???"},
      {"\xed\xa0\x80", "???"},       // half of a pair
      {"\xf4\x90\x80\x80", "????"},  // beyond Unicode
      {"\xe2\x82", "??"},            // cut off
      {"\xff\xfe", "??"}};
  for (const auto& [text, shown] : cases) {
    EXPECT_EQ(printable(text), shown);
    EXPECT_EQ(in_quotes(text), "'" + shown + "'");
  }
}

TEST(Printable, LinesStayWhereTheyAreMeant) {
  EXPECT_EQ(printable_lines("a\nb\x1b\n\xc2\x85\r\n"), "a\nb?\n??\n");
  const std::string long_text(10'000, 'x');
  EXPECT_EQ(printable_lines(long_text), long_text);
}

TEST(Printable, LongTextIsCutBetweenCharacters) {
  std::string text;
  for (int n = 0; n < 5000; ++n) text += "\xe2\x82\xac";
  EXPECT_EQ(printable(text), text.substr(0, 3 * 4096) + "...");
  EXPECT_EQ(in_quotes(text), "'" + text.substr(0, 3 * 60) + "'");
}

}  // namespace
}  // namespace isoweave::testing::volume_printable_test
