#include "report/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/print.hpp"

namespace isoweave::cli {
namespace {

constexpr auto kBarInterval = std::chrono::milliseconds(100);
constexpr auto kLineInterval = std::chrono::seconds(3);
constexpr std::size_t kBar = 10;
constexpr std::size_t kWidthWithBar = 40;

std::size_t terminal_width() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

double fraction_done(const Progress& progress) {
  if (progress.layers <= 0) return 0;
  return std::clamp(static_cast<double>(progress.layer) / static_cast<double>(progress.layers), 0.0, 1.0);
}

std::string bar_text(double fraction) {
  const auto full = static_cast<std::size_t>(std::lround(fraction * static_cast<double>(kBar)));
  return fmt::format("[{:.<{}}] ", std::string(full, '#'), kBar);
}

std::string time_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

// The parts of a line, the most important ones first.
std::vector<std::string> progress_parts(const Progress& progress, double seconds) {
  const double fraction = fraction_done(progress);
  std::vector<std::string> parts{fmt::format("{:.0f} %", std::floor(100 * fraction))};
  if (fraction > 0 && fraction < 1) parts.push_back(time_text(seconds * (1 - fraction) / fraction) + " left");
  // Files are put together after the last layer, and that of a packed mesh takes as long as its sweep.
  if (fraction == 1) parts.emplace_back("finishing the output");
  parts.push_back(fmt::format("layer {} of {}", progress.layer, progress.layers));
  if (seconds > 0)
    parts.push_back(fmt::format("{:.1f} Mvoxel/s", static_cast<double>(progress.voxels) * 1e-6 / seconds));
  if (progress.live_triangles + progress.final_triangles > 0) {
    parts.push_back(short_count(static_cast<double>(progress.live_triangles)) + " live triangles");
  }
  if (progress.bytes > 0) parts.push_back(byte_text(progress.bytes));
  return parts;
}

}  // namespace

std::string progress_line(const Progress& progress, double seconds, std::size_t width) {
  std::string text = width >= kWidthWithBar ? bar_text(fraction_done(progress)) : "";
  std::string comma;
  for (const std::string& part : progress_parts(progress, seconds)) {
    if (text.size() + comma.size() + part.size() > width) break;
    text += comma + part;
    comma = ", ";
  }
  return text;
}

std::string progress_text(const Progress& progress, double seconds) {
  std::string text;
  for (const std::string& part : progress_parts(progress, seconds)) text += (text.empty() ? "" : ", ") + part;
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
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (!on_terminal_) {
    print_note(progress_text(progress, seconds));
    return;
  }
  draw_line(progress_line(progress, seconds, terminal_width() - 1));
  bar_drawn_ = true;
}

void ProgressPrinter::finish() {
  if (!bar_drawn_) return;
  draw_line({});
  bar_drawn_ = false;
}

}  // namespace isoweave::cli
