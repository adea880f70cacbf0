#include "output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

namespace {

std::FILE* reserved = nullptr;  // nullptr: stdout itself

}  // namespace

void sparkhost::reserveStdout() {
  if (reserved) return;
  std::fflush(stdout);
  const int own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  // Without an open stdout nothing can be printed there.
  if (own < 0) return;
  reserved = fdopen(own, "w");
  if (!reserved || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return;
  // Lines appear where they are printed, between those of the log.
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
}

void sparkhost::survivePoorOutputs() {
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void sparkhost::printError(const std::string& text) noexcept {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

bool sparkhost::printOut(const std::string& text) {
  std::FILE* const out = reserved ? reserved : stdout;
  errno = 0;
  if (std::fputs(text.c_str(), out) >= 0 && std::fflush(out) == 0) return true;
  std::clearerr(out);
  return false;
}
