// Stands in for requests to servers where the build lacks libcurl.
#include "files/input_file.hpp"
#include "files/remote_store.hpp"

namespace isoweave {

#ifndef ISOWEAVE_HAS_HTTP
StorePtr open_remote_store(const std::string& url, const RemoteOptions&) {
  bad_input(shown_url(url), "a path that this build can open",
            "a URL, which needs libcurl (CMake option ISOWEAVE_HTTP=ON)");
}
#endif

}  // namespace isoweave
