#include "report/evidence.hpp"

#include "options/run.hpp"

namespace isoweave::cli {

Evidence::Evidence(const RunOptions& run, const PageOptions& page) : options_(page) {
  if (!run.report.empty()) report_.emplace(run.report);
  if (page.given()) page_.emplace(page.path);
}

void Evidence::write_forecast(const Json& forecast) {
  if (report_) write_report(*report_, forecast);
}

void Evidence::make_page(Json& report, const RunControl& control,
                         const std::function<PageContents(const RunControl&)>& contents) {
  RunControl quiet;
  quiet.threads = control.threads;
  quiet.schedule = control.schedule;
  quiet.stop = control.stop;
  quiet.measure = false;
  write_page(*page_, options_, report, contents(quiet), quiet);
}

void Evidence::write(Json report, const RunControl& control,
                     const std::function<PageContents(const RunControl&)>& contents) {
  try {
    if (page_) make_page(report, control, contents);
  } catch (...) {
    if (report_) write_report(*report_, report);
    throw;
  }
  if (report_) write_report(*report_, report);
}

}  // namespace isoweave::cli
