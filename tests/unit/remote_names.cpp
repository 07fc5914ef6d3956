// URLs: the part that is shown, the requests that they stand for, and answers about parts of objects.
#include <gtest/gtest.h>

#include <cstdlib>

#include "files/content_range.hpp"
#include "files/remote_address.hpp"
#include "isoweave/error.hpp"
#include "isoweave/remote.hpp"

namespace isoweave::testing::remote_names_test {
namespace {

// Sets a variable of the environment, or takes it away, until the test ends.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST(RemoteNames, UrlsAreToldFromPaths) {
  for (const char* url : {"http://h/a", "HTTPS://h", "s3://b/k", "gs://b"}) EXPECT_TRUE(is_url(url)) << url;
  for (const char* path :
       {"", "http", "http:/h", "ftp://h/a", "a/http://h", "generate:gyroid:8x8x8", "://", "/s3://b"}) {
    EXPECT_FALSE(is_url(path)) << path;
  }
}

TEST(RemoteNames, NoUserAndNoQueryIsShown) {
  EXPECT_EQ(shown_url("https://ann:word@host:8080/a/b.zarr/?sig=word#word"), "https://host:8080/a/b.zarr");
  EXPECT_EQ(shown_url("HTTP://a@b:w@h/x@y//"), "http://h/x@y");
  EXPECT_EQ(shown_url("https://h?sig=a/b@c"), "https://h");
  EXPECT_EQ(shown_url("s3://bucket/k"), "s3://bucket/k");
  EXPECT_EQ(shown_url("a?b#c@d/"), "a?b#c@d/");
}

TEST(RemoteNames, RequestsOfHttp) {
  const RemoteAddress address = remote_address("https://ann:word@host/a%20b/?sig=x#y");
  EXPECT_EQ(address.shown, "https://host/a%20b");
  EXPECT_EQ(address.request_url(address.shown + "/c/0 1?#"), "https://ann:word@host/a%20b/c/0%201%3F%23?sig=x");
  EXPECT_THROW(remote_address("https:///a"), BadInput);
}

TEST(RemoteNames, RequestsOfBuckets) {
  const Variable endpoint("AWS_ENDPOINT_URL", nullptr), first("AWS_REGION", nullptr),
      second("AWS_DEFAULT_REGION", nullptr);
  const Variable emulator("STORAGE_EMULATOR_HOST", nullptr);
  EXPECT_EQ(remote_address("s3://b/k").request_url("s3://b/k/a%b"), "https://b.s3.us-east-1.amazonaws.com/k/a%25b");
  EXPECT_EQ(remote_address("gs://b/k").request_url("gs://b/k/0"), "https://storage.googleapis.com/b/k/0");
  const Variable region("AWS_DEFAULT_REGION", "eu-west-2");
  EXPECT_EQ(remote_address("s3://b.c/k").request_url("s3://b.c/k"), "https://s3.eu-west-2.amazonaws.com/b.c/k");
  const Variable other("AWS_ENDPOINT_URL", "http://localhost:9000/");
  EXPECT_EQ(remote_address("s3://b/k").request_url("s3://b/k"), "http://localhost:9000/b/k");
}

TEST(RemoteNames, ContentRanges) {
  const auto range = parse_content_range(" bytes 5-7/100\r\n");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->first, 5U);
  EXPECT_EQ(range->last, 7U);
  EXPECT_EQ(range->size, 100U);
  EXPECT_EQ(parse_content_range("bytes 0-0/*")->size, std::nullopt);
  EXPECT_EQ(parse_content_range("bytes 0-18446744073709551614/18446744073709551615")->size, ~std::uint64_t{0});
  for (const char* text : {"", "bytes", "bytes 5-7", "bytes 7-5/100", "bytes 5-7/7", "bytes 5-7/100x", "bytes -5-7/9",
                           "bytes 5-/9", "items 5-7/100", "bytes 5-18446744073709551616/*", "bytes */100"}) {
    EXPECT_FALSE(parse_content_range(text)) << text;
  }
}

}  // namespace
}  // namespace isoweave::testing::remote_names_test
