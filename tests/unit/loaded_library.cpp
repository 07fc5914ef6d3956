#include "files/loaded_library.hpp"

#include <gtest/gtest.h>

#include "isoweave/error.hpp"

namespace isoweave::testing::loaded_library_test {
namespace {

const LibraryNeed kMaths{"/nowhere/libm.so.6", "libc6", "a format of this system", "sines"};

std::string message_of(const auto& call) {
  try {
    call();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(LoadedLibrary, IsFoundByItsNameWhereItHasMoved) {
  double (*cosine)(double) = nullptr;
  LoadedLibrary("a.sin", kMaths).find("cos", cosine);
  EXPECT_EQ(cosine(0), 1);
}

TEST(LoadedLibrary, IsMissedWithItsPackage) {
  const LibraryNeed none{"/nowhere/libnone.so.7", "libnone7", "a format of this system", "nones"};
  EXPECT_EQ(
      message_of([&] { LoadedLibrary("a.none", none); }),
      "a.none: expected a format of this system, found nones, whose library libnone.so.7 cannot be loaded (Debian's "
      "package libnone7)");
}

TEST(LoadedLibrary, RefusesToBeAnother) {
  double (*other)(double) = nullptr;
  EXPECT_EQ(message_of([&] { LoadedLibrary("a.sin", kMaths).find("uncos", other); }),
            "a.sin: expected function uncos in libm.so.6, found a library without it");
}

}  // namespace
}  // namespace isoweave::testing::loaded_library_test
