// sparktemplate: runs the programs of Webots' templates for the importer, one after the other, as foreign code: in a
// process of its own without files and sockets, with limits of memory and time. It reads requests from stdin and
// answers on stdout, until stdin ends. See request.h. Its argument is the CPU time of one template in seconds.

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "javascript.h"
#include "lua.h"

namespace {

using namespace spark::templates;
using nlohmann::json;

constexpr std::size_t kMostRequest = 256 << 20;  ///< bytes

void limit(int resource, std::size_t most) {
  const rlimit limits{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// From now on nothing can be opened or written, and no process started.
void confine() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which reserve terabytes
  limit(RLIMIT_AS, std::size_t{2} << 30);
#endif
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NOFILE, 0);
}

/// A signal ends the process when the time is over: of the CPU, and as a last resort by the clock.
void begin(int seconds) {
  const itimerval timer{{0, 0}, {seconds, 0}};
  ::setitimer(ITIMER_PROF, &timer, nullptr);
  ::alarm(static_cast<unsigned>(seconds) * 60);
}

bool readAll(void* to, std::size_t size) {
  for (auto* at = static_cast<char*>(to); size > 0;) {
    const ssize_t n = ::read(0, at, size);
    if (n == 0 || (n < 0 && errno != EINTR)) return false;
    if (n > 0) at += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool writeAll(const void* from, std::size_t size) {
  for (const auto* at = static_cast<const char*>(from); size > 0;) {
    const ssize_t n = ::write(1, at, size);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) at += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

json answer(const json& asked, int seconds) {
  const Request request{asked.at("text"), asked.at("fields"), asked.at("context")};
  Reply reply;
  begin(seconds);
  if (asked.at("language") == "lua")
    runLua(request, reply);
  else
    runJavascript(request, reply);
  begin(0);
  if (!reply.error.empty()) return {{"error", reply.error}, {"said", reply.said}};
  return {{"pieces", std::move(reply.pieces)}, {"said", std::move(reply.said)}};
}

}  // namespace

int main(int count, char** arguments) try {
  const int seconds = count > 1 ? std::atoi(arguments[1]) : 5;
  confine();
  for (std::uint32_t size = 0; readAll(&size, sizeof size) && size <= kMostRequest;) {
    std::string text(size, '\0');
    if (!readAll(text.data(), size)) break;
    const std::string out = answer(json::parse(text), seconds).dump(-1, ' ', false, json::error_handler_t::replace);
    const auto length = static_cast<std::uint32_t>(out.size());
    if (!writeAll(&length, sizeof length) || !writeAll(out.data(), out.size())) break;
  }
  ::_exit(0);
} catch (const std::exception& e) {
  std::fprintf(stderr, "sparktemplate: %s\n", e.what());
  ::_exit(1);
}
