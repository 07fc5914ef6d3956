#include "capi/guard.hpp"

#include <cstdlib>
#include <new>

#include "isoweave/error.hpp"

namespace isoweave::capi {
namespace {

// A text that the caller frees through iw_result_clear; null without memory.
char* copied(const std::string& text) noexcept {
  char* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy != nullptr) std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

iw_status fail(iw_result* result, iw_status status, const char* message) noexcept {
  if (result == nullptr || result->struct_size != sizeof(iw_result)) return status;
  try {
    result->message = copied(message);
  } catch (const std::bad_alloc&) {
    result->message = nullptr;  // the status says enough
  }
  return status;
}

}  // namespace

void require_size(std::size_t found, std::size_t largest) {
  // The size of a struct that begins with a size_t is a multiple of that. Any other may end within a pointer.
  constexpr std::size_t kStep = sizeof(std::size_t);
  if (found >= kStep && found <= largest && found % kStep == 0) return;
  throw std::invalid_argument("struct_size: expected a multiple of " + std::to_string(kStep) + " bytes, at most " +
                              std::to_string(largest) + ", found " + std::to_string(found));
}

void require_unused(std::int32_t reserved) {
  if (reserved == 0) return;
  throw std::invalid_argument("reserved: expected 0, found " + std::to_string(reserved));
}

void clear(iw_result* result) {
  if (result == nullptr) return;
  if (result->struct_size != sizeof(iw_result)) require_size(0, sizeof(iw_result));
  std::free(result->message);
  std::free(result->report);
  result->message = nullptr;
  result->report = nullptr;
}

void set_report(iw_result* result, const std::string& report) {
  if (result == nullptr) return;
  result->report = copied(report);
  if (result->report == nullptr) throw std::bad_alloc();
}

iw_status failed(iw_result* result, const std::exception_ptr& error) noexcept {
  try {
    std::rethrow_exception(error);
  } catch (const BadInput& e) {
    return fail(result, IW_BAD_INPUT, e.what());
  } catch (const CannotWrite& e) {
    return fail(result, IW_CANNOT_WRITE, e.what());
  } catch (const OverMemory& e) {
    return fail(result, IW_OVER_MEMORY, e.what());
  } catch (const DeviceError& e) {
    return fail(result, IW_DEVICE_ERROR, e.what());
  } catch (const Interrupted& e) {
    return fail(result, IW_STOPPED, e.what());
  } catch (const std::invalid_argument& e) {
    return fail(result, IW_BAD_ARGUMENT, e.what());
  } catch (const std::length_error& e) {
    return fail(result, IW_OVER_MEMORY, e.what());
  } catch (const std::bad_alloc&) {
    return fail(result, IW_OVER_MEMORY, "expected more memory than there is");
  } catch (const std::exception& e) {
    return fail(result, IW_FAILED, e.what());
  } catch (...) {
    return fail(result, IW_FAILED, "an exception of an unknown type");
  }
}

}  // namespace isoweave::capi
