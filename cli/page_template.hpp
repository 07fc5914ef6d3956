// The pages without their data, as built from viewer/. One mark, kPageMark, is where those go.
#pragma once

#include <string_view>

namespace isoweave::cli {

// Of a report and its mesh.
std::string_view page_template();

// Of a sweep that is watched; in builds with --watch.
std::string_view watch_template();

}  // namespace isoweave::cli
