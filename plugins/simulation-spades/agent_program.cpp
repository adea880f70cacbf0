#include "agent_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "spark/error.h"
#include "spark/output_file.h"

extern char** environ;

namespace spark::spades {

namespace {
namespace fs = std::filesystem;

/// A program by its name: in the folder of the type, else in PATH.
std::string programOf(const AgentType& type, const std::string& name) {
  const fs::path here = fs::path(type.folder) / name;
  return fs::exists(here) ? here.string() : name;
}

struct Actions {
  posix_spawn_file_actions_t list;
  Actions() { posix_spawn_file_actions_init(&list); }
  ~Actions() { posix_spawn_file_actions_destroy(&list); }
};
/// Closes all descriptors in the new program but 0, 1, 2 and those that it is given: also those that a library or a
/// plugin has opened without O_CLOEXEC.
void closeOthers(posix_spawn_file_actions_t& actions, const std::vector<AgentProgram::Descriptor>& given) {
  std::vector<int> kept;
  kept.reserve(given.size());
  for (const auto& [ours, theirs] : given) kept.push_back(theirs);
  std::sort(kept.begin(), kept.end());
  int next = 3;
  for (const int descriptor : kept) {
    for (; next < descriptor; ++next) posix_spawn_file_actions_addclose(&actions, next);
    next = std::max(next, descriptor + 1);
  }
  posix_spawn_file_actions_addclosefrom_np(&actions, next);
}

struct Attributes {
  posix_spawnattr_t list;
  Attributes() { posix_spawnattr_init(&list); }
  ~Attributes() { posix_spawnattr_destroy(&list); }
};
}  // namespace

AgentProgram::AgentProgram(const AgentType& type, const std::vector<std::string>& command, const std::string& log,
                           const std::vector<Descriptor>& descriptors) {
  Actions actions;
  posix_spawn_file_actions_addopen(&actions.list, 0, "/dev/null", O_RDONLY, 0);
  const OutputFile out(log.empty() ? "/dev/null" : log + "-stdout.log", "what an agent prints"),
      errors(log.empty() ? "/dev/null" : log + "-stderr.log", "what an agent prints");
  posix_spawn_file_actions_adddup2(&actions.list, out.descriptor(), 1);
  posix_spawn_file_actions_adddup2(&actions.list, errors.descriptor(), 2);
  for (const auto& [ours, theirs] : descriptors) posix_spawn_file_actions_adddup2(&actions.list, ours, theirs);
  closeOthers(actions.list, descriptors);
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
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int error = ::posix_spawnp(&pid_, programOf(type, command.front()).c_str(), &actions.list, &attributes.list,
                                   arguments.data(), environ);
  if (error != 0)
    throw Error(fmt::format("cannot start '{}' in {}: {}", command.front(), type.folder, std::strerror(error)));
  end_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
}

AgentProgram::~AgentProgram() {
  ::kill(-pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (end_ >= 0) ::close(end_);
}

void AgentProgram::addEnd(std::vector<pollfd>& out) const {
  if (!ended()) out.push_back({end_, POLLIN, 0});
}

bool AgentProgram::ended() const {
  // It is reaped by the destructor only: until then no other group can have its number.
  siginfo_t info = {};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_;
}

std::string AgentProgram::countInstructions() {
  try {
    if (!counter_) counter_ = std::make_unique<InstructionCounter>(pid_);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

void AgentProgram::beginThought() {
  cpuAtBegin_ = cpuSeconds();
  if (counter_) countAtBegin_ = counter_->count();
}

AgentLink::Message AgentProgram::measured(std::string text) const {
  return {std::move(text), cpuSeconds() - cpuAtBegin_, counter_ ? counter_->count() - countAtBegin_ : 0};
}

double AgentProgram::cpuSeconds() const {
  clockid_t clock;
  timespec t;
  if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &t) != 0) return 0;
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace spark::spades
