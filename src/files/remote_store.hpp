// Objects that a server has below a URL.
#pragma once

#include <string>

#include "files/object_store.hpp"
#include "isoweave/remote.hpp"

namespace isoweave {

// Throws BadInput for a URL without a host, and for any in a build without libcurl.
StorePtr open_remote_store(const std::string& url, const RemoteOptions& options);

// Throws std::invalid_argument for options out of range.
void check_remote_options(const RemoteOptions& options);

}  // namespace isoweave
