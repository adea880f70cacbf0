#include "process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "test_support.h"

extern char** environ;

namespace spark::test {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

Process::Process(const std::vector<std::string>& command) : name_(fs::path(command.front()).filename()) {
  char errorName[] = "/tmp/spark-stderr-XXXXXX";
  const int errors = mkostemp(errorName, O_CLOEXEC);
  errorFile_ = errorName;
  int pipes[2];
  if (errors < 0 || pipe2(pipes, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipes[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& a : command) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  const int code = posix_spawnp(&pid_, command.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipes[1]);
  close(errors);
  out_ = pipes[0];
  if (code != 0) {
    ended_ = true;
    throw std::runtime_error(fmt::format("cannot start {}: {}", command.front(), std::strerror(code)));
  }
}

Process::~Process() {
  if (!ended_) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (out_ >= 0) close(out_);
  fs::remove(errorFile_);
}

void Process::tooLong(const std::string& what) {
  throw std::runtime_error(
      fmt::format("{} took longer than {} s to {}; it said:\n{}", name_, kPatience.count(), what, errors()));
}

/// Reads once; false at the end of the stream.
bool Process::fill() {
  struct pollfd p = {out_, POLLIN, 0};
  const int ready = poll(&p, 1, static_cast<int>(std::chrono::milliseconds(kPatience).count()));
  if (ready == 0) tooLong("print a line");
  char bytes[4096];
  const ssize_t n = read(out_, bytes, sizeof bytes);
  if (n > 0) buffer_.append(bytes, static_cast<std::size_t>(n));
  return n > 0;
}

std::string Process::line() {
  std::size_t end;
  while ((end = buffer_.find('\n')) == std::string::npos)
    if (!fill())
      throw std::runtime_error(fmt::format("{} ended without a further line; it said:\n{}", name_, errors()));
  std::string out = buffer_.substr(0, end);
  buffer_.erase(0, end + 1);
  return out;
}

std::string Process::rest() {
  while (fill()) {
  }
  return std::exchange(buffer_, {});
}

int Process::wait() {
  const auto last = Clock::now() + kPatience;
  while (!ended_) {
    const int got = waitpid(pid_, &status_, WNOHANG);
    if (got == pid_) {
      ended_ = true;
    } else {
      if (Clock::now() > last) tooLong("end");
      struct pollfd p = {out_, POLLHUP, 0};  // its stdout closes when it ends
      poll(&p, 1, 10);
    }
  }
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

void Process::signal(int number) { kill(pid_, number); }

void Process::halt() {
  kill(pid_, SIGSTOP);
  if (waitpid(pid_, &status_, WUNTRACED) == pid_ && !WIFSTOPPED(status_)) ended_ = true;
}

std::string Process::errors() const { return textOf(errorFile_); }

void Process::waitForError(const std::string& text) {
  const auto last = Clock::now() + kPatience;
  while (errors().find(text) == std::string::npos) {
    if (Clock::now() > last) tooLong("say '" + text + "'");
    struct pollfd p = {out_, 0, 0};
    if (poll(&p, 1, 10) > 0 && errors().find(text) == std::string::npos)
      throw std::runtime_error(fmt::format("{} ended without saying '{}'; it said:\n{}", name_, text, errors()));
  }
}

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> withoutLimits() {
  std::vector<std::string> out;
  for (const char* limit : {"/sys/server/gamecontrol.syncTimeout", "/sys/server/gamecontrol.joinWait",
                            "/sys/server/gamecontrol.idleLimit", "/sys/host/watchdog.after"})
    out.insert(out.end(), {"--set", std::string(limit) + "=0"});
  return out;
}

std::vector<std::string> sparkctl(int pid) {
  return {program("sparkctl"), "--pid", std::to_string(pid), "--timeout", std::to_string(kPatience.count())};
}

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

Finished runToEnd(const std::vector<std::string>& command) {
  Process p(command);
  Finished f;
  f.out = p.rest();
  f.code = p.wait();
  f.errors = p.errors();
  return f;
}

}  // namespace spark::test
