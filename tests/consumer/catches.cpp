// An exception of the library is caught by its own type and by that of its base, also across a shared library's border.
#include <cstdio>
#include <string>

#include "isoweave/error.hpp"
#include "isoweave/volume.hpp"

int main() {
  int caught = 0;
  try {
    isoweave::open_volume("not_there.nrrd");
  } catch (const isoweave::BadInput& error) {
    caught += std::string(error.what()).starts_with("not_there.nrrd") ? 1 : 0;
  }
  try {
    isoweave::open_volume("not_there.nrrd");
  } catch (const isoweave::Error&) {
    ++caught;
  }
  std::puts(caught == 2 ? "caught" : "not caught");
  return caught == 2 ? 0 : 1;
}
