// mesh --watch without a browser: who may look, what is told, and that nobody who looks changes or delays the run.
// viewer/test looks at the page in a browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"
#include "watch_client.hpp"

namespace isoweave::testing::cli_watching_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;
using program::listing;
using program::Result;
using program::run;
using program::Running;
using namespace watch;
using Words = std::vector<std::string>;

constexpr const char* kVolume =
    testing::kSanitized ? "generate:gyroid:40x40x160:uint8" : "generate:gyroid:64x64x160:uint8";

Words mesh(const Words& more, const std::string& volume = kVolume) {
  Words arguments{"mesh", volume, "--iso", "127.5", "-o", "out.ply", "--slab", "8", "--report", "out.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expect_refused(const Words& more, const std::string& says) {
  const files::Folder folder;
  program::expect_failed(run(folder.path(), mesh(more)), 2, says);
  EXPECT_EQ(listing(folder), Words{});
}

#ifndef ISOWEAVE_HAS_WATCH

TEST(CliWatch, BuildsWithoutItSaySo) { expect_refused({"--watch"}, "--watch: expected a build with the viewer"); }

#else

constexpr const char* kEndless = "generate:gyroid:96x96x2000000:uint8";

Json report_of(const files::Folder& folder) { return Json::parse(files::read_bytes(folder / "out.json")); }

struct News {
  Json json;
  std::string final, undecided;  // 18 bytes each
};

class Page {
 public:
  explicit Page(const Address& address) : address_(address) {}

  News ask_news() {
    const std::string query = "news?bits=" + std::to_string(bits_) + "&final=" + std::to_string(final_.size() / 18) +
                              "&frame=" + std::to_string(frame_);
    const Answer answer = ask(address_, request(address_.path + query));
    EXPECT_EQ(answer.status, 200);
    if (answer.body.size() < 4) return {};
    std::uint32_t length = 0;
    std::memcpy(&length, answer.body.data(), sizeof(length));
    News news{Json::parse(answer.body.substr(4, length)), "", ""};
    const std::size_t final_bytes = 18 * news.json["final"]["triangles"].get<std::size_t>();
    const std::size_t undecided_bytes = 18 * news.json["undecided"]["triangles"].get<std::size_t>();
    EXPECT_EQ(answer.body.size(), 4 + length + final_bytes + undecided_bytes);
    news.final = answer.body.substr(4 + length, final_bytes);
    news.undecided = answer.body.substr(4 + length + final_bytes);
    if (news.json["final"]["from"] == 0) final_.clear();
    EXPECT_EQ(news.json["final"]["from"], final_.size() / 18);
    final_ += news.final;
    bits_ = news.json["final"]["bits"];
    frame_ = news.json["frame"];
    return news;
  }

  bool has_all(const News& news) const {
    return news.json.contains("result") && news.json["final"]["held"] == final_.size() / 18;
  }
  const std::string& final() const { return final_; }

 private:
  Address address_;
  int bits_ = 0;
  std::uint64_t frame_ = 0;
  std::string final_;
};

TEST(CliWatch, OnlyWhoKnowsTheAddressSeesThePage) {
  const files::Folder folder;
  Running program(folder.path(), mesh({"--watch"}, kEndless));
  const Address address = address_of(program);
  const Answer page = ask(address, request(address.path));
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("connect-src 'self'"), std::string::npos);
  EXPECT_NE(page.body.find("\"input\":\"generate:gyroid"), std::string::npos);
  EXPECT_EQ(page.body.find("%%"), std::string::npos);
  EXPECT_NE(page.head.find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_NE(page.head.find("Referrer-Policy: no-referrer"), std::string::npos);
  EXPECT_EQ(page.head.find("Access-Control"), std::string::npos);
  EXPECT_EQ(ask(address, request(address.path + "news")).status, 200);
  EXPECT_EQ(ask(address, request(address.path, "Host: localhost:1\r\n")).status, 200);

  std::string wrong = address.path;
  wrong[1] = wrong[1] == '0' ? '1' : '0';
  for (const std::string& path : {std::string("/"), wrong, wrong + "news", address.path + "other", std::string("/news"),
                                  address.path.substr(0, address.path.size() - 1), address.path.substr(0, 17) + "/"}) {
    const Answer answer = ask(address, request(path));
    EXPECT_EQ(answer.status, 404) << path;
    EXPECT_EQ(answer.body, "") << path;
  }
  // Names that somebody has pointed to this machine, no name, two names.
  for (const std::string& head :
       {std::string("Host: evil.example\r\n"), std::string("Host: 127.0.0.1.evil.example\r\n"),
        std::string("Host: localhost.evil.example:80\r\n"), std::string(),
        std::string("Host: 127.0.0.1\r\nHost: evil.example\r\n")}) {
    for (const std::string& path : {address.path, address.path + "news"}) {
      const Answer answer = ask(address, request(path, head));
      EXPECT_EQ(answer.status, 403) << head;
      EXPECT_EQ(answer.body, "") << head;
    }
  }
  for (const std::string method : {"POST", "PUT", "DELETE", "OPTIONS"}) {
    EXPECT_EQ(ask(address, request(address.path, "Host: 127.0.0.1\r\nContent-Length: 0\r\n", method)).status, 405);
  }
  EXPECT_FALSE(program.has_ended());
}

TEST(CliWatch, ListensOnLoopbackOnly) {
  const files::Folder folder;
  Running program(folder.path(), mesh({"--watch"}, kEndless));
  const Address address = address_of(program);
  std::ostringstream port;
  port << std::uppercase << std::hex << std::setw(4) << std::setfill('0') << address.port;
  int found = 0;
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream in(table);
    for (std::string line, number, local, remote, state; std::getline(in, line);) {
      std::istringstream(line) >> number >> local >> remote >> state;
      if (state != "0A" || !local.ends_with(":" + port.str())) continue;  // 0A: listens
      EXPECT_EQ(local, "0100007F:" + port.str());
      ++found;
    }
  }
  EXPECT_EQ(found, 1);
}

TEST(CliWatch, ThePageIsToldTheMesh) {
  const files::Folder folder;
  Running program(folder.path(), {"mesh", kVolume, "--iso", "127.5", "-o", "out.stl", "--slab", "8", "--report",
                                  "out.json", "--watch"});
  Page page(address_of(program));
  std::uint64_t undecided = 0;
  News news = page.ask_news();
  while (!page.has_all(news)) {
    undecided = std::max<std::uint64_t>(undecided, news.undecided.size() / 18);
    EXPECT_LE(news.json["final"]["held"], news.json["numbers"]["final"]);
    ASSERT_FALSE(program.has_ended()) << program.err();
    news = page.ask_news();
  }
  const Result result = program.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  const Json report = report_of(folder);
  EXPECT_GT(undecided, 1000U);
  EXPECT_EQ(page.final().size() / 18, report["triangles"]);
  EXPECT_EQ(news.json["result"]["triangles"], report["triangles"]);
  EXPECT_EQ(news.json["result"]["vertices"], report["vertices"]);
  EXPECT_EQ(news.json["result"]["digest"], report["digest"]);
  EXPECT_EQ(news.json["numbers"]["final"], report["triangles"]);
  EXPECT_EQ(news.json["numbers"]["undecided"], 0);
  EXPECT_EQ(news.json["plot"]["layer"].size(), report["sweep"].size());
  for (std::size_t slab = 0; slab < report["sweep"].size(); ++slab) {
    EXPECT_EQ(news.json["plot"]["live"][slab], report["sweep"][slab]["live_triangles"]);
    EXPECT_EQ(news.json["plot"]["bytes"][slab], report["sweep"][slab]["bytes"]);
  }

  // The triangles of the file, in its order, on the grid: that begins a sample before the volume.
  const std::string stl = files::read_bytes(folder / "out.stl");
  constexpr std::size_t kHead = 84;
  ASSERT_EQ(stl.size(), kHead + 50 * (page.final().size() / 18));
  double farthest = 0;
  for (std::size_t n = 0; n < page.final().size() / 18; ++n) {
    std::array<std::uint16_t, 9> steps{};
    std::array<float, 9> corners{};
    std::memcpy(steps.data(), page.final().data() + 18 * n, sizeof(steps));
    std::memcpy(corners.data(), stl.data() + kHead + 50 * n + 12, sizeof(corners));
    for (std::size_t i = 0; i < 9; ++i)
      farthest = std::max(farthest, std::abs(steps[i] * 161.0 / 65535 - 1 - corners[i]));
  }
  EXPECT_LT(farthest, 0.51 * 161 / 65535);
}

TEST(CliWatch, PagesThatDrawSlowlyGetTheResult) {
  const files::Folder folder;
  Running program(folder.path(), {"mesh", "generate:gyroid:96x96x80:uint8", "--iso", "127.5", "--error", "0", "-o",
                                  "out.ply", "--watch"});
  Page page(address_of(program));
  std::optional<Clock::time_point> complete;
  for (News news = page.ask_news(); !page.has_all(news); news = page.ask_news()) {
    if (!complete && news.json.contains("result")) complete = Clock::now();
    ASSERT_FALSE(program.has_ended()) << program.err();
    std::this_thread::sleep_for(2s);
  }
  ASSERT_TRUE(complete);
  EXPECT_GT(Clock::now() - *complete, 6s);  // longer than anybody may be silent
  EXPECT_EQ(program.wait().code, 0);
}

TEST(CliWatch, PagesThatWereClosedAreWaitedForForFiveSeconds) {
  const files::Folder folder;
  Running program(folder.path(), {"mesh", "generate:gyroid:96x96x80:uint8", "--iso", "127.5", "--error", "0", "-o",
                                  "out.ply", "--watch"});
  Page(address_of(program)).ask_news();  // for a part of the surface at most
  const Clock::time_point asked = Clock::now();
  EXPECT_EQ(program.wait().code, 0);
  EXPECT_LT(Clock::now() - asked, 20s);
}

TEST(CliWatch, WhoWatchesChangesNothing) {
  const files::Folder alone;
  ASSERT_EQ(run(alone.path(), mesh({"--quiet"})).code, 0);
  const files::Folder watched;
  const Result nobody = run(watched.path(), mesh({"--watch"}));
  EXPECT_EQ(nobody.code, 0) << nobody.err;
  EXPECT_EQ(report_of(watched)["digest"], report_of(alone)["digest"]);
  EXPECT_EQ(files::read_bytes(watched / "out.ply"), files::read_bytes(alone / "out.ply"));
}

TEST(CliWatch, ATakenPortIsANoteAndNoError) {
  const files::Folder folder;
  Running first(folder.path(), mesh({"--watch"}, kEndless));
  const std::string port = std::to_string(address_of(first).port);
  const files::Folder other;
  const Result second = run(other.path(), mesh({"--watch=" + port}));
  EXPECT_EQ(second.code, 0);
  EXPECT_NE(second.err.find("isoweave: --watch=" + port + ": expected a port that is free, found it taken"),
            std::string::npos)
      << second.err;
  EXPECT_EQ(second.err.find("watch at"), std::string::npos) << second.err;
  const files::Folder alone;
  ASSERT_EQ(run(alone.path(), mesh({"--quiet"})).code, 0);
  EXPECT_EQ(report_of(other)["digest"], report_of(alone)["digest"]);
}

TEST(CliWatch, APortCanBeChosen) {
  const files::Folder folder;
  int port = 0;
  {
    Running first(folder.path(), mesh({"--watch"}, kEndless));
    port = address_of(first).port;
  }
  Running second(folder.path(), mesh({"--watch=" + std::to_string(port)}, kEndless));
  EXPECT_EQ(address_of(second).port, port);
}

// Some ask and never read, some never ask, one asks letter by letter.
class BadClients {
 public:
  explicit BadClients(const Address& address) : stop_(false) {
    for (int n = 0; n < 6; ++n) {
      idle_.push_back(std::make_unique<Connection>(address.port));
      idle_.back()->send(request(address.path + "news"));
      idle_.push_back(std::make_unique<Connection>(address.port));
    }
    dripping_ = std::thread([this, address] {
      while (!stop_) {
        Connection slow(address.port);
        for (int letter = 0; letter < 100 && !stop_ && slow.send("G"); ++letter) std::this_thread::sleep_for(50ms);
      }
    });
  }
  ~BadClients() {
    stop_ = true;
    dripping_.join();
  }

 private:
  std::vector<std::unique_ptr<Connection> > idle_;
  std::atomic<bool> stop_;
  std::thread dripping_;
};

TEST(CliWatch, WhoNeverReadsNeitherStallsTheRunNorFillsItsMemory) {
  const std::string volume =
      testing::kSanitized ? "generate:gyroid:64x64x256:uint8" : "generate:gyroid:128x128x256:uint8";
  const files::Folder alone;
  ASSERT_EQ(run(alone.path(), mesh({"--quiet"}, volume)).code, 0);
  const files::Folder folder;
  Running program(folder.path(), mesh({"--watch"}, volume));
  const BadClients clients(address_of(program));
  const Result result = program.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  const Json before = report_of(alone);
  const Json after = report_of(folder);
  EXPECT_EQ(after["digest"], before["digest"]);
  if (testing::kSanitized) return;
  EXPECT_LT(after["seconds"]["total"].get<double>(), 2 * before["seconds"]["total"].get<double>() + 2);
  EXPECT_LT(after["memory"]["peak_bytes"].get<double>(), before["memory"]["peak_bytes"].get<double>() + 64e6);
}

TEST(CliWatch, InterruptedRunsEndAtOnceWhoeverWatches) {
  const files::Folder folder;
  Running program(folder.path(), mesh({"--watch"}, kEndless));
  const Address address = address_of(program);
  const BadClients clients(address);
  Page page(address);
  while (page.ask_news().json["numbers"]["layer"] == 0) std::this_thread::sleep_for(20ms);
  const Clock::time_point start = Clock::now();
  ::kill(program.process(), SIGINT);
  const Result result = program.wait();
  EXPECT_LT(Clock::now() - start, testing::kSanitized ? 10s : 2s);
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_NE(result.err.find("isoweave: interrupted"), std::string::npos) << result.err;
  EXPECT_EQ(listing(folder), Words{});
}

// As by Ctrl-Z, or when a laptop is closed.
TEST(CliWatch, WhoAskedBeforeTheRunWasStoppedIsAnsweredWhenItGoesOn) {
  const files::Folder folder;
  Running program(folder.path(), mesh({"--watch"}, kEndless));
  const Address address = address_of(program);
  const std::string question = request(address.path + "news");
  Connection connection(address.port);
  ASSERT_TRUE(connection.send(question.substr(0, 10)));
  std::this_thread::sleep_for(200ms);  // until it has been read
  ::kill(program.process(), SIGSTOP);
  EXPECT_TRUE(connection.send(question.substr(10)));
  std::this_thread::sleep_for(1500ms);  // more than anybody has to ask
  ::kill(program.process(), SIGCONT);
  EXPECT_EQ(parsed(connection.read_all()).status, 200);
}

TEST(CliWatch, ACapOnMemoryCountsWhatWatchingHolds) {
  const files::Folder folder;
  const Result small = run(folder.path(), mesh({"--watch", "--memory", "90M"}));
  program::expect_failed(small, 5, "or more, found 90M");
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  ASSERT_EQ(run(folder.path(), mesh({"--memory", "90M", "--quiet"})).code, 0);
  Running program(folder.path(), mesh({"--watch", "--memory", "200M"}, "generate:gyroid:128x128x256:uint8"));
  Page page(address_of(program));
  for (News news = page.ask_news(); !page.has_all(news); news = page.ask_news()) std::this_thread::sleep_for(20ms);
  EXPECT_EQ(program.wait().code, 0);
  EXPECT_LT(report_of(folder)["memory"]["peak_bytes"], 200'000'000);
}

TEST(CliWatch, WhatCannotBeWatchedIsRefused) {
  expect_refused({"--watch=port"}, "--watch: expected a port from 1 to 65535, or 0 for any that is free, found 'port'");
  expect_refused({"--watch=70000"}, "--watch: expected a port");
  expect_refused({"--watch=-1"}, "--watch: expected a port");
  expect_refused({"--watch", "--device", "cuda"},
                 "--device cuda: expected a run without --watch, which takes processors");
  expect_refused({"--watch", "--quiet"}, "--quiet");
  expect_refused({"--watch", "--dry-run"}, "--dry-run");
}

TEST(CliWatch, AResumedRunCanBeWatched) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"--quiet"})).code, 0);
  const Json before = report_of(folder);
  program::Setup setup;
  setup.signal = SIGTERM;
  setup.ready = [&](pid_t) { return std::filesystem::exists(folder / "run/state-0"); };
  const Result stopped = run(folder.path(), mesh({"--checkpoint", "run", "--every", "1layers"}), setup);
  if (stopped.code == 0) GTEST_SKIP() << "it was faster than the signal";
  Running program(folder.path(), {"mesh", "--resume", "run", "--watch"});
  Page page(address_of(program));
  for (News news = page.ask_news(); !page.has_all(news); news = page.ask_news()) {
    ASSERT_FALSE(program.has_ended()) << program.err();
  }
  EXPECT_EQ(program.wait().code, 0);
  EXPECT_EQ(report_of(folder)["digest"], before["digest"]);
}

#endif

}  // namespace
}  // namespace isoweave::testing::cli_watching_test
