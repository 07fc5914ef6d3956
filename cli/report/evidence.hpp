// The files beside a mesh of mesh or simplify that tell of its run: the report and the page.
#pragma once

#include <functional>
#include <optional>

#include "isoweave/output_file.hpp"
#include "options/run.hpp"
#include "page/page.hpp"
#include "report/report.hpp"

namespace isoweave::cli {

class Evidence {
 public:
  // Opens the files that are asked for, before the run, so that nothing is computed in vain.
  Evidence(const RunOptions& run, const PageOptions& page);

  // Completes the report, without a page.
  void write_forecast(const Json& forecast);

  // Completes the report and the page. `contents` is called where a page is to be made, with a quiet control. The
  // report is written even if the page fails.
  void write(Json report, const RunControl& control, const std::function<PageContents(const RunControl&)>& contents);

 private:
  void make_page(Json& report, const RunControl& control,
                 const std::function<PageContents(const RunControl&)>& contents);

  const PageOptions& options_;
  std::optional<OutputFile> report_, page_;
};

}  // namespace isoweave::cli
