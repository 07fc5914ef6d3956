#include "report/print.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <system_error>

#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"
#include "ranks.hpp"

namespace isoweave::cli {
namespace {

std::string one_line(std::string_view text) {
  while (text.ends_with('\n')) text.remove_suffix(1);
  return printable(text);
}

// Writes a text. Returns 0, or the error number of the failure. Of several ranks one writes for all.
int write_to(std::FILE* stream, std::string_view text) {
  if (!speaks()) return 0;
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0;
  return written ? 0 : errno != 0 ? errno : EIO;
}

[[noreturn]] void refuse_output(int error) {
  throw CannotWrite("standard output: cannot write: " + std::generic_category().message(error));
}

int fail(int code, std::string_view text) {
  print_note(text);
  return code;
}

}  // namespace

void print_out(std::string_view text) {
  const int error = write_to(stdout, printable_lines(text));
  if (error != 0) refuse_output(error);
}

void print_to_reader(std::string_view text) {
  const int error = write_to(stdout, printable_lines(text));
  if (error != 0 && error != EPIPE) refuse_output(error);
}

void print_note(std::string_view text) { write_to(stderr, "isoweave: " + one_line(text) + "\n"); }

void draw_line(std::string_view text) { write_to(stderr, "\r\x1b[K" + one_line(text)); }

int report_error(const std::exception& error) {
  const auto is = [&]<class E>(const E*) { return dynamic_cast<const E*>(&error) != nullptr; };
  if (is(static_cast<EmptySurface*>(nullptr))) {
    return fail(kExitBadInput, fmt::format("{} (--allow-empty writes an empty mesh)", error.what()));
  }
  if (is(static_cast<BadInput*>(nullptr))) return fail(kExitBadInput, error.what());
  if (is(static_cast<CannotWrite*>(nullptr))) return fail(kExitCannotWrite, error.what());
  if (is(static_cast<OverMemory*>(nullptr))) return fail(kExitOverMemory, error.what());
  if (is(static_cast<DeviceError*>(nullptr))) return fail(kExitDevice, error.what());
  if (is(static_cast<Interrupted*>(nullptr))) return fail(kExitInterrupted, error.what());
  if (is(static_cast<std::bad_alloc*>(nullptr)) || is(static_cast<std::length_error*>(nullptr))) {
    return fail(kExitOverMemory, "not enough memory");
  }
  if (is(static_cast<std::invalid_argument*>(nullptr))) return fail(kExitUsage, error.what());
  return fail(kExitInternal, fmt::format("internal error: {}", error.what()));
}

std::string unit_text(std::string_view unit) { return unit.empty() ? "mm" : printable(unit); }

std::string size_text(const std::array<double, 3>& size, std::string_view unit) {
  return fmt::format("{:.6g} x {:.6g} x {:.6g} {}", size[0], size[1], size[2], unit_text(unit));
}

std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t place = 0; place < digits.size(); ++place) {
    if (place > 0 && (digits.size() - place) % 3 == 0) text += ',';
    text += digits[place];
  }
  return text;
}

std::string short_count(double number) {
  if (number >= 1e9) return fmt::format("{:.2f} G", number * 1e-9);
  if (number >= 1e6) return fmt::format("{:.2f} M", number * 1e-6);
  if (number >= 1e4) return fmt::format("{:.1f} k", number * 1e-3);
  return fmt::format("{:.0f}", number);
}

std::string byte_text(std::uint64_t bytes) {
  const auto number = static_cast<double>(bytes);
  if (number >= 1e9) return fmt::format("{:.2f} GB", number * 1e-9);
  return fmt::format("{:.{}f} MB", number * 1e-6, number < 1e7 ? 2 : 0);
}

}  // namespace isoweave::cli
