#include "apart.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>

#include "spark/error.h"

namespace spark::meshes {

namespace {
constexpr char kResult = 'r', kFailure = 'f';
constexpr std::size_t kMostResult = std::size_t{1} << 30, kMemory = std::size_t{3} << 29;  // bytes
constexpr unsigned kSeconds = 10;  // of CPU time: the simulation may wait for it

/// `margin`: between the limit that sends a signal and the one that kills.
void limit(int resource, std::size_t most, std::size_t margin = 0) {
  const rlimit limits{most, most + margin};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// What holds in the copy: it has limits, ends by every signal that ends a process, and with its parent, prints
/// nothing, and has no descriptor but `to`: it would hold connections open that are closed here, and pipes of other
/// copies.
void prepareCopy(int to) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  limit(RLIMIT_AS, pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + kMemory);
  limit(RLIMIT_CPU, kSeconds, 5);
  limit(RLIMIT_CORE, 0);
  for (const int ending :
       {SIGALRM, SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGXCPU, SIGPIPE, SIGINT, SIGTERM, SIGHUP})
    ::signal(ending, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::alarm(10 * kSeconds);  // should it wait for a lock that another thread held when the copy was made
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int output : {1, 2}) ::dup2(nowhere, output);
  ::close_range(3, static_cast<unsigned>(to) - 1, 0);
  ::close_range(static_cast<unsigned>(to) + 1, ~0U, 0);
}

void writeAll(int to, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(to, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR) return;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

/// Reads to the end, or more than kMostResult.
std::string readAll(int from) {
  std::string out;
  std::array<char, 65536> part;
  while (out.size() <= kMostResult) {
    const ssize_t n = ::read(from, part.data(), part.size());
    if (n > 0) out.append(part.data(), static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EINTR)) break;
  }
  return out;
}

/// How a copy ended that has no result.
std::string endOf(int status) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU) return fmt::format("the reader took more than {} s of CPU time", kSeconds);
  if (signal == SIGALRM) return fmt::format("the reader took more than {} s", 10 * kSeconds);
  return signal ? fmt::format("the reader crashed: {}", ::strsignal(signal)) : std::string("the reader crashed");
}

[[noreturn]] void doInCopy(const std::function<std::string()>& work, int to) {
  to = ::fcntl(to, F_DUPFD_CLOEXEC, 3);  // this process may have begun without an output
  prepareCopy(to);
  std::string out;
  try {
    out = work();
    out.insert(out.begin(), kResult);
  } catch (const std::bad_alloc&) {
    out = kFailure + std::string("the reader needs more than 1.5 GiB of memory");
  } catch (const std::exception& e) {
    out = kFailure + std::string(e.what());
  }
  writeAll(to, out);
  ::_exit(0);
}
}  // namespace

std::string doneApart(const std::function<std::string()>& work) {
  std::array<int, 2> pipe;
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw Error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  const pid_t copy = ::fork();
  if (copy == 0) doInCopy(work, pipe[1]);
  ::close(pipe[1]);
  if (copy < 0) {
    ::close(pipe[0]);
    throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }
  std::string out = readAll(pipe[0]);
  ::close(pipe[0]);  // which ends a copy that still writes
  int status = 0;
  while (::waitpid(copy, &status, 0) < 0 && errno == EINTR) {
  }
  if (out.size() > kMostResult) throw Error("what the reader made of it has more than 1 GiB");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || out.empty()) throw Error(endOf(status));
  const bool failed = out.front() == kFailure;
  out.erase(0, 1);
  if (failed) throw Error(out);
  return out;
}

}  // namespace spark::meshes
