// The pages without their data, as built from viewer/. The mark kPageMark stands where the data go.
#pragma once

#include <string_view>

namespace isoweave::cli {

// The page of a report and its mesh.
std::string_view page_template();

// The page of the iso-values of a volume.
std::string_view range_template();

// The page of a sweep that is watched; in builds with --watch.
std::string_view watch_template();

}  // namespace isoweave::cli
