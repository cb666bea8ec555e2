// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The program with its live view, and a page that controls it.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include <repel/base/types.hpp>

#include "end_to_end/teleop.hpp"
#include "support/web_page.hpp"

namespace repel::test {

using Json = nlohmann::json;

/// A child process, terminated by the destructor at the latest.
class LiveTeleop {
 public:
  explicit LiveTeleop(std::vector<std::string> arguments,
                      const std::string& listen = "127.0.0.1:0") {
    arguments.insert(arguments.begin(), REPEL_TELEOP);
    for (const std::string& more : {std::string("--view"), std::string("--listen"), listen}) {
      arguments.push_back(more);
    }
    std::vector<char*> words;
    for (std::string& word : arguments) words.push_back(word.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    const int how = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, (folder_ / "out").c_str(), how, 0600);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, (folder_ / "err").c_str(), how, 0600);
    if (::posix_spawn(&program_, REPEL_TELEOP, &files, nullptr, words.data(), environ) != 0) {
      program_ = -1;
    }
    posix_spawn_file_actions_destroy(&files);
    find_port();
  }
  LiveTeleop(const LiveTeleop&) = delete;
  LiveTeleop& operator=(const LiveTeleop&) = delete;
  ~LiveTeleop() {
    if (program_ > 0) (void)end_with(SIGKILL);
  }

  /// Port of the live view; 0: none was reported.
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] bool runs() const { return program_ > 0 && ::kill(program_, 0) == 0; }
  /// Interrupts it as Ctrl-C does.
  Ending interrupt() { return end_with(SIGINT); }

 private:
  void find_port() {
    static constexpr std::string_view words = "Live view: ";
    const auto until = std::chrono::steady_clock::now() + patience;
    while (program_ > 0 && std::chrono::steady_clock::now() < until) {
      const std::string err = text_of(folder_ / "err");
      const std::size_t begin = err.find(words);
      const std::size_t end = err.find("/\n", begin);
      if (begin != std::string::npos && end != std::string::npos) {
        port_ = port_of(err.substr(begin, end - begin));
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "no live view: " << text_of(folder_ / "err");
  }
  Ending end_with(int signal) {
    (void)::kill(program_, signal);
    int raw = 0;
    (void)::waitpid(program_, &raw, 0);
    program_ = -1;
    const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
    return {status, text_of(folder_ / "out"), text_of(folder_ / "err")};
  }

  Folder folder_;
  pid_t program_ = -1;
  std::uint16_t port_ = 0;
};

/// A page that parses the messages it receives.
class LivePage {
 public:
  using Such = std::function<bool(const Json&)>;

  explicit LivePage(const LiveTeleop& program) : page_(program.port()) {
    EXPECT_EQ(page_.status(), 101);
  }

  void say(const Json& message) { (void)page_.say(message.dump()); }
  /// The first message of that type that fulfils the condition; null on timeout. `meanwhile` is
  /// called repeatedly while waiting, many times a second.
  Json await(
      const std::string& type, const Such& such = [](const Json&) { return true; },
      const std::function<void()>& meanwhile = [] {}) {
    const auto until = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < until && !page_.ended()) {
      meanwhile();
      const auto text = page_.next(std::chrono::milliseconds(50));
      if (!text) continue;
      Json message = Json::parse(*text);
      if (message.at("type") == type && such(message)) return message;
    }
    ADD_FAILURE() << "no such " << type << " comes; closed with " << page_.close_code();
    return nullptr;
  }
  /// Moves the hand until such a frame arrives.
  Json drive(const Vec3& velocity, const Such& such) {
    const Json servo{{"type", "servo_cv"},
                     {"linear", {velocity.x(), velocity.y(), velocity.z()}},
                     {"angular", {0, 0, 0}},
                     {"frame", "world"},
                     {"clutch", true}};
    return await("frame", such, [&] { say(servo); });
  }
  Json take() {
    say({{"type", "take"}});
    return await("operator", [](const Json& who) { return who.at("you") == true; });
  }
  /// The reason for which the message is refused.
  std::string refusal_of(const Json& message) {
    say(message);
    const Json answer = await("refused");
    return answer.is_null() ? std::string() : answer.at("why").get<std::string>();
  }
  WebPage& page() { return page_; }

 private:
  WebPage page_;
};

/// [N] Virtual force on the tool of an arm in a frame.
inline double force_of(const Json& frame, std::size_t arm = 0) {
  double sum = 0.0;
  for (const Json& x : frame.at("arms")[arm].at("force")) sum += x.get<double>() * x.get<double>();
  return std::sqrt(sum);
}

inline bool has_status(const Json& frame, const char* name) {
  for (const Json& each : frame.at("status")) {
    if (each == name) return true;
  }
  return false;
}

}  // namespace repel::test
