// Asks a run that is watched, over a connection of the test's own.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <regex>
#include <sstream>
#include <string>
#include <thread>

#include "program.hpp"

namespace isoweave::watch {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// A connection to a port of this machine.
class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool connected() const { return connected_; }
  bool send(const std::string& text) {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  std::string read_all() {
    std::string text;
    std::array<char, 65536> buffer{};
    ssize_t got = 0;
    while ((got = ::recv(socket_, buffer.data(), buffer.size(), 0)) > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(got));
    }
    return text;
  }

 private:
  int socket_;
  bool connected_ = false;
};

struct Address {
  int port = 0;
  std::string path;  // "/TOKEN/"
};

struct Answer {
  int status = 0;
  std::string head, body;
};

inline Answer parsed(const std::string& text) {
  Answer answer;
  const std::size_t end = text.find("\r\n\r\n");
  if (end == std::string::npos) return answer;
  answer.head = text.substr(0, end);
  answer.body = text.substr(end + 4);
  std::istringstream(answer.head.substr(answer.head.find(' '))) >> answer.status;
  return answer;
}

inline std::string request(const std::string& path, const std::string& head = "Host: 127.0.0.1:1\r\n",
                           const std::string& method = "GET") {
  return method + " " + path + " HTTP/1.1\r\n" + head + "\r\n";
}

inline Answer ask(const Address& address, const std::string& text) {
  Connection connection(address.port);
  if (!connection.send(text)) return {};
  return parsed(connection.read_all());
}

// Where a run says that its page is.
inline Address address_of(const program::Running& program) {
  const Clock::time_point give_up = Clock::now() + 60s;
  const std::regex line("isoweave: watch at http://127\\.0\\.0\\.1:([0-9]+)(/[0-9a-f]{32}/)\n");
  std::smatch match;
  while (Clock::now() < give_up && !program.has_ended()) {
    const std::string err = program.err();
    if (std::regex_search(err, match, line)) return {std::stoi(match[1]), match[2]};
    std::this_thread::sleep_for(5ms);
  }
  ADD_FAILURE() << "no address: " << program.err();
  return {};
}

}  // namespace isoweave::watch
