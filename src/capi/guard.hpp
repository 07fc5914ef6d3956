// The border between the C interface and C++: sizes of structs on their way in and out, exceptions as statuses.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "isoweave/isoweave.h"

namespace isoweave::capi {

// Refuses a struct whose size is not one that this library or an earlier one has.
// @throws std::invalid_argument
void require_size(std::size_t found, std::size_t largest);

// Refuses a reserved member that a later library might read.
// @throws std::invalid_argument
void require_unused(std::int32_t reserved);

// A struct of the caller with the members that its header does not have yet set to 0; all of them where it is null.
template <class Struct>
Struct taken(const Struct* given) {
  Struct all{};
  if (given != nullptr) {
    require_size(given->struct_size, sizeof(Struct));
    std::memcpy(&all, given, given->struct_size);
    if constexpr (requires { all.reserved; }) require_unused(all.reserved);
  }
  all.struct_size = sizeof(Struct);
  return all;
}

// Hands a struct back to the caller, as far as there is room.
template <class Struct>
void hand_back(const Struct& all, Struct* out) {
  if (out == nullptr) throw std::invalid_argument("expected a struct to fill in, found NULL");
  const std::size_t size = out->struct_size;
  require_size(size, sizeof(Struct));
  std::memcpy(out, &all, size);
  out->struct_size = size;
}

// @throws std::invalid_argument naming the argument, where it is null
template <class Object>
Object& required(Object* object, const char* name) {
  if (object == nullptr) throw std::invalid_argument(std::string(name) + ": expected a pointer, found NULL");
  return *object;
}

// A text, empty where it is null.
inline std::string text_of(const char* text) { return text == nullptr ? std::string() : std::string(text); }

// Frees a result's texts before a call. Ignores null.
void clear(iw_result* result);

// Keeps a report for the caller, who may not want one.
void set_report(iw_result* result, const std::string& report);

// The status of an exception, with its message in the result.
iw_status failed(iw_result* result, const std::exception_ptr& error) noexcept;

// Does the work of a call.
template <class Work>
iw_status guarded(iw_result* result, const Work& work) noexcept {
  try {
    clear(result);
    work();
    return IW_DONE;
  } catch (...) {
    return failed(result, std::current_exception());
  }
}

}  // namespace isoweave::capi
