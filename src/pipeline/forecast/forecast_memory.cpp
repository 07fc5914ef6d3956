// The memory of the whole process in the forecast of a run.
#include <algorithm>

#include "isoweave/forecast.hpp"
#include "pipeline/memory_cap.hpp"
#include "system/process_memory.hpp"

namespace isoweave {

void add_iso_value(Forecast& sum, const Forecast& value) {
  const bool is_first = sum.peak_bytes == 0;
  sum.triangles_extracted += value.triangles_extracted;
  sum.triangles += value.triangles;
  sum.vertices += value.vertices;
  sum.peak_bytes += is_first ? value.peak_bytes : value.surface_bytes;
  sum.least_bytes = sum.peak_bytes;
  sum.surface_bytes += value.surface_bytes;
  sum.seconds += value.seconds;
}

void add_memory_during(Forecast& forecast, std::uint64_t bytes) {
  forecast.peak_bytes += bytes;
  if (forecast.least_bytes_at_once > 0) forecast.least_bytes_at_once += bytes;
  forecast.least_bytes = std::max(forecast.least_bytes + bytes, with_slack(system::peak_bytes()));
}

void add_memory_after(Forecast& forecast, std::uint64_t bytes) {
  forecast.least_bytes = std::max(forecast.least_bytes, with_slack(bytes));
}

void require_memory(const Forecast& forecast, std::uint64_t cap, const std::string& where, const std::string& purpose) {
  if (cap == 0 || without_slack(forecast.least_bytes) <= cap) return;
  refuse_cap(where, forecast.least_bytes, cap, purpose.empty() ? "" : " (for " + purpose + ")");
}

}  // namespace isoweave
