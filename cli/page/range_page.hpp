// The page of info --isos: a chart of the triangles of surfaces over the range of iso-values.
#pragma once

#include "isoweave/output_file.hpp"
#include "report/report.hpp"

namespace isoweave::cli {

// Writes the page of a report of info that has `isos`, and completes the file.
void write_range_page(OutputFile& file, const Json& report);

}  // namespace isoweave::cli
