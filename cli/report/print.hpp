// The texts that the program prints: results on standard output, everything else on standard error.
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

namespace isoweave::cli {

inline constexpr int kExitInternal = 1;  // a bug
inline constexpr int kExitUsage = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitCannotWrite = 4;
inline constexpr int kExitOverMemory = 5;
inline constexpr int kExitDevice = 6;
inline constexpr int kExitInterrupted = 130;

// Everything that is printed goes through these four functions. Whatever characters a file or its name brought in, only
// printable ones and ends of lines reach a terminal.

// Writes to standard output and makes sure that the text has been written. Throws CannotWrite.
void print_out(std::string_view text);

// Writes text for a reader who may stop early: a pipe that is closed meanwhile is no error.
void print_to_reader(std::string_view text);

// Prints "isoweave: TEXT" as one line on standard error. A note that cannot be written is lost without an error: it is
// not worth a mesh.
void print_note(std::string_view text);

// Draws over the line of the terminal that standard error is; an empty text wipes it off.
void draw_line(std::string_view text);

// Prints an error and returns its exit code.
int report_error(const std::exception& error);

// The unit of a length: "mm" where none is said, as everywhere.
std::string unit_text(std::string_view unit);

// Three lengths with their unit: "181 x 217 x 181 mm".
std::string size_text(const std::array<double, 3>& size, std::string_view unit);

// 1234567 -> "1,234,567"; 1234567 -> "1.23 M"; 1572864 -> "1.57 MB".
std::string grouped(std::uint64_t number);
std::string short_count(double number);
std::string byte_text(std::uint64_t bytes);

}  // namespace isoweave::cli
