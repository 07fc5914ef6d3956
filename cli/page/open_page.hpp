// Shows a page that has been written, in the browser of the desktop.
#pragma once

#include <string>

namespace isoweave::cli {

// Opens a page in the browser of the desktop, and does not wait for the browser to end. Throws CannotWrite, with the
// way round, where no program opens pages or the one that there is cannot.
void open_page(const std::string& path);

}  // namespace isoweave::cli
