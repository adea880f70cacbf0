#include "child.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "spark/error.h"

namespace spark::bench {

namespace {
void writeAll(int fd, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n <= 0) return;
    done += static_cast<std::size_t>(n);
  }
}

std::string readAll(int fd) {
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(fd, buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  return text;
}
}  // namespace

Child::Child(const std::function<Json(int line)>& work) {
  int line[2], result[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, line) != 0 || pipe(result) != 0) throw Error("cannot make a pipe to a child");
  std::fflush(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw Error("cannot start a child");
  if (pid_ == 0) {
    close(line[0]);
    close(result[0]);
    Json answer;
    try {
      answer = {{"value", work(line[1])}};
    } catch (const std::exception& e) {
      answer = {{"error", e.what()}};
    }
    writeAll(result[1], answer.dump());
    _exit(0);
  }
  close(line[1]);
  close(result[1]);
  line_ = line[0];
  result_ = result[0];
}

Child::~Child() {
  if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
  close(line_);
  close(result_);
}

Json Child::result() {
  const std::string text = readAll(result_);
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  if (text.empty())
    throw Error(fmt::format("the measuring process ended with status {:#x} and without a result", status));
  Json answer = Json::parse(text);
  if (answer.contains("error")) throw Error(answer["error"].get<std::string>());
  return answer["value"];
}

}  // namespace spark::bench
