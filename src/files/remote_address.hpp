// The URLs of volumes: which requests they stand for, and what of them may be shown.
#pragma once

#include <string>

#include "files/http_client.hpp"

namespace isoweave {

struct RemoteAddress {
  std::string shown;    // the URL that was opened, without a user, a query and a slash at its end
  std::string server;   // the beginning of all shown paths: "https://host", "s3://bucket"
  std::string base;     // the beginning of requests in its place
  std::string query{};  // behind every request: "?...", or nothing
  HttpAccess access{};
  bool encodes = false;  // paths are names of objects (s3, gs), no parts of URLs

  // The URL of a request for a path that begins with `server`.
  std::string request_url(const std::string& path) const;
};

// Takes a URL apart, with what the environment says of its scheme: for s3 AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY,
// AWS_SESSION_TOKEN, AWS_REGION or AWS_DEFAULT_REGION, AWS_ENDPOINT_URL; for gs GOOGLE_OAUTH_ACCESS_TOKEN and
// STORAGE_EMULATOR_HOST. Throws BadInput for a URL without a host or bucket.
RemoteAddress remote_address(const std::string& url);

}  // namespace isoweave
