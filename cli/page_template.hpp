// The page without a report and a mesh, as built from viewer/.
#pragma once

#include <string_view>

namespace isoweave::cli {

// One mark, %%data%%, is where they go.
std::string_view page_template();

}  // namespace isoweave::cli
