#include "files/curl_library.hpp"

#include "files/input_file.hpp"
#include "files/loaded_library.hpp"
#include "system/shared_library.hpp"

namespace isoweave {
namespace {

// An older library passes over options that it does not know, those that keep redirects safe among them.
void check_version(const CurlFunctions& curl, const std::string& url) {
  const curl_version_info_data& version = *curl.version_info(CURLVERSION_NOW);
  if (version.version_num < CURL_VERSION_BITS(7, 87, 0)) {
    bad_input(url, "libcurl 7.87 or later", "libcurl " + std::string(version.version));
  }
}

CurlFunctions load_functions(const std::string& url) {
  const LoadedLibrary library(
      url, {system::library_file("curl", 4), "libcurl4", "a path that this system can open", "a URL"});
  CurlFunctions curl;
  library.find("curl_version_info", curl.version_info);
  library.find("curl_global_init", curl.global_init);
  library.find("curl_easy_init", curl.easy_init);
  library.find("curl_easy_setopt", curl.easy_setopt);
  library.find("curl_easy_getinfo", curl.easy_getinfo);
  library.find("curl_easy_strerror", curl.easy_strerror);
  library.find("curl_easy_cleanup", curl.easy_cleanup);
  library.find("curl_multi_init", curl.multi_init);
  library.find("curl_multi_add_handle", curl.multi_add_handle);
  library.find("curl_multi_remove_handle", curl.multi_remove_handle);
  library.find("curl_multi_perform", curl.multi_perform);
  library.find("curl_multi_info_read", curl.multi_info_read);
  library.find("curl_multi_poll", curl.multi_poll);
  library.find("curl_multi_cleanup", curl.multi_cleanup);
  library.find("curl_slist_append", curl.slist_append);
  library.find("curl_slist_free_all", curl.slist_free_all);
  check_version(curl, url);
  // Must come before any other call that opens something.
  if (curl.global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK) bad_input(url, "a working libcurl", "one that does not start");
  return curl;
}

}  // namespace

const CurlFunctions& curl_functions(const std::string& url) {
  static const CurlFunctions kFunctions = load_functions(url);
  return kFunctions;
}

}  // namespace isoweave
