#include "agent_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "spark/error.h"

extern char** environ;

namespace spark::spades {

namespace {
namespace fs = std::filesystem;
/// A pipe whose ends are closed in programs that are started.
std::array<int, 2> makePipe() {
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  return ends;
}

/// A copy of a descriptor above all that an agent may want, so that assigning its own cannot overwrite it.
int moveUp(int descriptor) {
  const int high = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 300);
  if (high < 0) throw Error(fmt::format("cannot copy a descriptor: {}", std::strerror(errno)));
  ::close(descriptor);
  return high;
}

/// The program of a type: in its folder, else in PATH.
std::string programOf(const AgentType& type) {
  const fs::path here = fs::path(type.folder) / type.command.front();
  return fs::exists(here) ? here.string() : type.command.front();
}

struct Actions {
  posix_spawn_file_actions_t list;
  Actions() { posix_spawn_file_actions_init(&list); }
  ~Actions() { posix_spawn_file_actions_destroy(&list); }
};
struct Attributes {
  posix_spawnattr_t list;
  Attributes() { posix_spawnattr_init(&list); }
  ~Attributes() { posix_spawnattr_destroy(&list); }
};
}  // namespace

AgentProcess::AgentProcess(const AgentType& type, const std::string& log) {
  const std::array<int, 2> to = makePipe(), from = makePipe();
  const int reads = moveUp(to[0]), writes = moveUp(from[1]);

  Actions actions;
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions.list, 0, "/dev/null", O_RDONLY, 0);
  const std::string out = log.empty() ? "/dev/null" : log + "-stdout.log",
                    errors = log.empty() ? "/dev/null" : log + "-stderr.log";
  posix_spawn_file_actions_addopen(&actions.list, 1, out.c_str(), kFlags, 0644);
  posix_spawn_file_actions_addopen(&actions.list, 2, errors.c_str(), kFlags, 0644);
  posix_spawn_file_actions_adddup2(&actions.list, reads, type.in);
  posix_spawn_file_actions_adddup2(&actions.list, writes, type.out);
  posix_spawn_file_actions_addchdir_np(&actions.list, type.folder.c_str());
  // A group of its own, so that what it starts ends with it, and Ctrl-C at the host does not reach it first.
  Attributes attributes;
  sigset_t none, usual;
  sigemptyset(&none);
  sigfillset(&usual);
  posix_spawnattr_setsigmask(&attributes.list, &none);
  posix_spawnattr_setsigdefault(&attributes.list, &usual);
  posix_spawnattr_setflags(&attributes.list, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<char*> arguments;
  for (const std::string& word : type.command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int error =
      ::posix_spawnp(&pid_, programOf(type).c_str(), &actions.list, &attributes.list, arguments.data(), environ);
  ::close(reads);
  ::close(writes);
  if (error != 0) {
    ::close(to[1]);
    ::close(from[0]);
    throw Error(fmt::format("cannot start '{}' in {}: {}", type.command.front(), type.folder, std::strerror(error)));
  }
  pipes_ = std::make_unique<FrameStream>(from[0], to[1]);
}

AgentProcess::~AgentProcess() { kill(); }

bool AgentProcess::ended() {
  // It is reaped in kill() only: until then no other group can have its number.
  siginfo_t info = {};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_;
}

void AgentProcess::kill() {
  ::kill(-pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void AgentProcess::send(std::string_view message) {
  if (beginsCycle(message)) {
    cpuAtBegin_ = cpuSeconds();
    if (counter_) countAtBegin_ = counter_->count();
  }
  pipes_->send(message);
}

std::optional<AgentLink::Message> AgentProcess::receive() {
  const auto text = pipes_->receive();
  if (!text) return std::nullopt;
  return Message{std::string(*text), cpuSeconds() - cpuAtBegin_, counter_ ? counter_->count() - countAtBegin_ : 0};
}

std::string AgentProcess::countInstructions() {
  try {
    if (!counter_) counter_ = std::make_unique<InstructionCounter>(pid_);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

void AgentProcess::addDescriptors(std::vector<pollfd>& out) const {
  if (!lost().empty()) return;  // a closed pipe would be ready all the time
  out.push_back({pipes_->input(), POLLIN, 0});
  if (pipes_->output() >= 0) out.push_back({pipes_->output(), POLLOUT, 0});
}

double AgentProcess::cpuSeconds() const {
  clockid_t clock;
  timespec t;
  if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &t) != 0) return 0;
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace spark::spades
