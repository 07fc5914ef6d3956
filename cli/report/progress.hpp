// A run's progress on standard error: a bar on a terminal, now and then a plain line elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "isoweave/pipeline.hpp"

namespace isoweave::cli {

enum class ProgressMode : std::uint8_t { kAuto, kAlways, kNever };  // auto: only on a terminal

class ProgressPrinter {
 public:
  explicit ProgressPrinter(ProgressMode mode);
  ~ProgressPrinter();
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void show(const Progress& progress);

  // Wipes the bar off, so that other lines can follow.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  bool on_terminal_;
  bool shown_;
  bool bar_drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

// The line about the progress of a run; `seconds` since the start. Percent and time left come first.
std::string progress_text(const Progress& progress, double seconds);

// The same with a bar, for a terminal of so many columns: what does not fit is left out at the end.
std::string progress_line(const Progress& progress, double seconds, std::size_t width);

}  // namespace isoweave::cli
