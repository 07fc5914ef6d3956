// What the program says, and to whom: results on standard output, everything else on standard error.
#pragma once

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

// Writes to standard output and sees to it that the text got there. Throws CannotWrite.
void print_out(std::string_view text);

// "isoweave: TEXT" as one line on standard error, whatever characters a file name brought in.
void print_note(std::string_view text);

// Says what went wrong and returns the exit code that stands for it.
int report_error(const std::exception& error);

// 1234567 -> "1,234,567"; 1234567 -> "1.23 M"; 1572864 -> "1.57 MB".
std::string grouped(std::uint64_t number);
std::string short_count(double number);
std::string byte_text(std::uint64_t bytes);

}  // namespace isoweave::cli
