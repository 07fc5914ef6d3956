// Volumes on servers: Zarr, OME-Zarr, N5 and neuroglancer's precomputed volumes by URL.
//
// http:// and https:// are asked as they are, with proxies and certificates of curl's usual environment;
// s3://BUCKET/KEY as AWS_REGION or AWS_ENDPOINT_URL say, signed where AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY are
// set (AWS_SESSION_TOKEN with them), else as anybody; gs://BUCKET/KEY at storage.googleapis.com, with the token of
// GOOGLE_OAUTH_ACCESS_TOKEN where it is set. A user in a URL and what stands behind its '?' go along with every
// request, and into no message, report or VolumeInfo.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// How servers are asked. Nothing here changes the samples.
struct RemoteOptions {
  double timeout = 30;  // seconds without any byte until a request has failed; above 0
  int tries = 5;        // of a request that fails by a fault that may pass, with pauses that grow; 1 to 100
  int requests = 8;     // at a time; 1 to 256
  std::uint64_t ahead = std::uint64_t{64} << 20;    // bytes of chunks that are read before they are needed; 0: none
  std::shared_ptr<const std::atomic<bool>> stop{};  // set it, from a signal handler say: a read throws Interrupted
};

// The options in the environment: ISOWEAVE_REMOTE_TIMEOUT, _TRIES, _REQUESTS and _AHEAD, the values above where it is
// silent.
// @throws std::invalid_argument naming a variable of another value
RemoteOptions remote_options();

// Whether a path is that of a volume on a server: http://, https://, s3:// or gs://.
bool is_url(std::string_view path);

// A URL as messages and reports show it: without a user, and without what stands behind '?' or '#'. Other paths as they
// are.
std::string shown_url(const std::string& path);

// Opens a volume on a server; open_volume() does so too, with the options of the environment. Metadata are read here,
// chunks when they are needed, each once in a sweep, and those of the coming slices before. A chunk that the server
// does not have (status 404) is the fill value. VolumeInfo::part names the version of the metadata that was read, by
// ETag or time, so that saved states and tasks are refused where it has changed.
// @throws BadInput as open_volume(), for requests that fail, and for any URL in a build or on a system without libcurl;
//   std::invalid_argument for options out of range, by the names of the variables above
std::unique_ptr<SliceSource> open_remote_volume(const std::string& url, const OpenOptions& options,
                                                const RemoteOptions& remote);

}  // namespace isoweave
#pragma GCC visibility pop
