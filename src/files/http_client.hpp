// Requests to servers by HTTP, several at a time, all of them in the thread that waits for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isoweave {

// The credentials that a request shows. No message has any of them.
struct HttpAccess {
  std::string bearer;         // an OAuth 2 token; empty: none
  std::string signed_for;     // the service that requests are signed for, as curl's AWS SigV4 takes it; empty: unsigned
  std::string key, secret;    // what they are signed with
  std::string session_token;  // that belongs to the key; empty: none
};

struct HttpRequest {
  std::string url;
  HttpAccess access{};
  bool head = false;       // ask for the headers alone
  std::string range{};     // bytes as "FIRST-LAST"; empty: all
  std::uint64_t most = 0;  // bytes of the body, unpacked; a longer one is not read to its end
};

struct HttpAnswer {
  int status = 0;         // 0: there was none
  std::string failure{};  // what went wrong beneath HTTP; empty: nothing
  bool lasting = false;   // trying again does not mend the failure
  bool too_long = false;
  std::vector<std::byte> body{};         // of status 200 and 206 alone
  std::optional<std::uint64_t> bytes{};  // of the body, as the headers say
  std::string etag{}, modified{}, content_range{};
  double retry_after = 0;  // seconds that the server asks to wait; 0: it does not
};

// Not thread-safe.
class HttpClient {
 public:
  // url: what is opened, as it may be shown, for the error where libcurl is missing.
  // timeout: a request without any byte for so many seconds of waiting has failed.
  HttpClient(const std::string& url, double timeout);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  // `number` tells the request from others under way.
  void start(std::uint64_t number, const HttpRequest& request);

  // Ends a request that nobody waits for any more; nothing where it is over.
  void cancel(std::uint64_t number);

  struct Done {
    std::uint64_t number = 0;
    HttpAnswer answer;
  };

  // Works on all requests until one is over, for at most `seconds`; nothing where none is over by then.
  std::optional<Done> wait(double seconds);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace isoweave
