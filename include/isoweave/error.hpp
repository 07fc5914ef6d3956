// Errors that the library throws. The library never prints, exits or aborts.
//
// Every what() is one line that names the file or option, what was expected and what was found. A bad argument from the
// calling program (a NaN spacing, an empty span) is std::invalid_argument, which is no Error.
#pragma once

#include <stdexcept>

#pragma GCC visibility push(default)
namespace isoweave {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A volume or mesh that cannot be found, opened, understood or read to its end.
class BadInput : public Error {
 public:
  using Error::Error;
};

// A mesh without triangles, where the caller wants one (RunControl::allow_empty). what() says why nothing is there.
class EmptySurface : public BadInput {
 public:
  using BadInput::BadInput;
};

// An output that cannot be created, written, completed or represented in its format.
class CannotWrite : public Error {
 public:
  using Error::Error;
};

// The run would need more memory than it was given.
class OverMemory : public Error {
 public:
  using Error::Error;
};

// No usable device, or the device failed.
class DeviceError : public Error {
 public:
  using Error::Error;
};

// The caller asked the run to stop. Nothing is left behind but a saved state, if a folder for states was given.
class Interrupted : public Error {
 public:
  using Error::Error;
};

}  // namespace isoweave
#pragma GCC visibility pop
