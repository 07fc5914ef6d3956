#include "report/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "report/print.hpp"

namespace isoweave::cli {
namespace {

constexpr auto kBarInterval = std::chrono::milliseconds(100);
constexpr auto kLineInterval = std::chrono::seconds(3);
constexpr std::size_t kShortestBar = 5;
constexpr std::size_t kLongestBar = 20;

std::size_t terminal_width() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

double fraction_done(const Progress& progress) {
  if (progress.layers <= 0) return 0;
  return std::clamp(static_cast<double>(progress.layer) / static_cast<double>(progress.layers), 0.0, 1.0);
}

// A bar as long as there is room for, or none.
std::string bar_text(double fraction, std::size_t room) {
  constexpr std::size_t kFrame = 3;
  if (room < kShortestBar + kFrame) return {};
  const std::size_t length = std::min(room - kFrame, kLongestBar);
  const auto full = static_cast<std::size_t>(std::lround(fraction * static_cast<double>(length)));
  return fmt::format("[{:.<{}}] ", std::string(full, '#'), length);
}

std::string time_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

std::string progress_text(const Progress& progress, double seconds) {
  std::string text = fmt::format("layer {} of {}", progress.layer, progress.layers);
  if (seconds > 0) text += fmt::format(", {:.1f} Mvoxel/s", static_cast<double>(progress.voxels) * 1e-6 / seconds);
  const std::uint64_t triangles = progress.live_triangles + progress.final_triangles;
  if (triangles > 0)
    text += fmt::format(", {} live triangles", short_count(static_cast<double>(progress.live_triangles)));
  if (progress.bytes > 0) text += ", " + byte_text(progress.bytes);
  const double fraction = fraction_done(progress);
  if (fraction > 0 && fraction < 1) text += ", " + time_text(seconds * (1 - fraction) / fraction) + " left";
  return text;
}

ProgressPrinter::ProgressPrinter(ProgressMode mode)
    : on_terminal_(::isatty(STDERR_FILENO) == 1),
      shown_(mode == ProgressMode::kAlways || (mode == ProgressMode::kAuto && on_terminal_)),
      last_(start_) {}

ProgressPrinter::~ProgressPrinter() { finish(); }

void ProgressPrinter::show(const Progress& progress) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  const bool complete = progress.layer >= progress.layers;
  const Clock::duration interval = on_terminal_ ? Clock::duration(kBarInterval) : Clock::duration(kLineInterval);
  if (now - last_ < interval && !complete) return;
  last_ = now;
  const std::string text = progress_text(progress, std::chrono::duration<double>(now - start_).count());
  if (!on_terminal_) {
    print_note(text);
    return;
  }
  const std::size_t width = terminal_width() - 1;
  const std::size_t room = width - std::min(width, text.size());
  const std::string line = (bar_text(fraction_done(progress), room) + text).substr(0, width);
  draw_line(line);
  bar_drawn_ = true;
}

void ProgressPrinter::finish() {
  if (!bar_drawn_) return;
  draw_line({});
  bar_drawn_ = false;
}

}  // namespace isoweave::cli
