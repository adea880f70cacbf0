#include "template_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "spark/error.h"

namespace spark::webots {

namespace {

constexpr std::size_t kMostAnswer = 512 << 20;  ///< bytes
constexpr const char* kName = "sparktemplate";

bool readAll(int from, void* to, std::size_t size) {
  for (auto* at = static_cast<char*>(to); size > 0;) {
    const ssize_t n = ::read(from, at, size);
    if (n == 0 || (n < 0 && errno != EINTR)) return false;
    if (n > 0) at += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// Over a socket, so that an end of the process is an error here, not a signal.
bool sendAll(int to, const void* from, std::size_t size) {
  for (const auto* at = static_cast<const char*>(from); size > 0;) {
    const ssize_t n = ::send(to, at, size, MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) at += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

TemplateProcess::~TemplateProcess() { stop(); }

std::string TemplateProcess::path() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  std::vector<fs::path> folders{fs::canonical("/proc/self/exe", ignored).parent_path()};
  folders.push_back(folders[0].parent_path() / "bin");  // of the tests of a build
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&TemplateProcess::path), &info) != 0 && info.dli_fname) {
    const fs::path here = fs::absolute(info.dli_fname, ignored).parent_path();
    folders.push_back(here.parent_path() / "bin");                              // of a build
    folders.push_back(here.parent_path().parent_path().parent_path() / "bin");  // lib/spark/plugins
  }
  for (const fs::path& folder : folders)
    if (fs::exists(folder / kName, ignored)) return folder / kName;
  return folders[0] / kName;
}

void TemplateProcess::start() {
  std::array<int, 2> sockets;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    throw Error(fmt::format("cannot make a socket: {}", std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&actions, sockets[1], 0);
  ::posix_spawn_file_actions_adddup2(&actions, sockets[1], 1);
  ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = kName, seconds = std::to_string(seconds_);
  std::array<char*, 3> arguments{name.data(), seconds.data(), nullptr};
  const int error = ::posix_spawn(&pid_, program_.c_str(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  ::close(sockets[1]);
  socket_ = sockets[0];
  if (error == 0) return;
  pid_ = -1;
  stop();
  throw Error(fmt::format("cannot start '{}', which runs templates: {}", program_, std::strerror(error)));
}

void TemplateProcess::stop() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

void TemplateProcess::fail() {
  ended_ = true;
  ::close(socket_);
  socket_ = -1;
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGPROF || signal == SIGXCPU)
    throw Error(fmt::format("the template takes more than {} s of CPU time", seconds_));
  if (signal == SIGALRM) throw Error("the template takes more than five minutes");
  throw Error(signal ? fmt::format("the template crashes its process: {}", ::strsignal(signal))
                     : std::string("the template needs too much memory"));
}

std::string TemplateProcess::ask(const std::string& request) {
  // A file may have many of those that never end.
  if (ended_) throw Error("no template is run after one that ended its process");
  if (pid_ < 0) start();
  const auto length = static_cast<std::uint32_t>(request.size());
  if (!sendAll(socket_, &length, sizeof length) || !sendAll(socket_, request.data(), request.size())) fail();
  std::uint32_t size = 0;
  if (!readAll(socket_, &size, sizeof size)) fail();
  if (size > kMostAnswer) {
    ended_ = true;
    stop();
    throw Error("the template writes too much");
  }
  std::string out(size, '\0');
  if (!readAll(socket_, out.data(), out.size())) fail();
  return out;
}

}  // namespace spark::webots
