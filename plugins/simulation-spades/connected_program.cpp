// The kernel lists each TCP socket with its two addresses and its inode in /proc/net/tcp, and the inodes that a process
// holds are links in /proc/PID/fd.
#include "connected_program.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace spark::spades {

namespace fs = std::filesystem;

namespace {
/// An address as in /proc/net/tcp, "0100007F:0C1C"; `six`: as in /proc/net/tcp6.
std::string listed(const sockaddr_in& a, bool six) {
  const char* const mapped = six ? "0000000000000000FFFF0000" : "";
  return fmt::format("{}{:08X}:{:04X}", mapped, static_cast<std::uint32_t>(a.sin_addr.s_addr), ntohs(a.sin_port));
}

/// The inode of the socket with these addresses, "0" if it is closed; nullopt: the kernel does not say.
std::optional<std::string> inodeOf(const sockaddr_in& own, const sockaddr_in& other) {
  bool isListed = false;
  for (const bool six : {false, true}) {
    std::ifstream list(six ? "/proc/net/tcp6" : "/proc/net/tcp");
    isListed |= list.good();
    for (std::string line; std::getline(list, line);) {
      std::istringstream words(line);
      std::string number, local, remote, word, inode;
      words >> number >> local >> remote;
      if (local != listed(own, six) || remote != listed(other, six)) continue;
      for (int i = 3; i < 9; ++i) words >> word;  // state, queues, timer, retransmits, user, timeout
      if (words >> inode) return inode;
    }
  }
  return isListed ? std::optional<std::string>("0") : std::nullopt;
}

bool holds(const fs::path& process, const std::string& inode) {
  std::error_code error;
  const fs::path socket = "socket:[" + inode + "]";
  for (fs::directory_iterator fd(process / "fd", error), end; !error && fd != end; fd.increment(error)) {
    std::error_code gone;
    if (fs::read_symlink(fd->path(), gone) == socket) return true;
  }
  return false;
}
}  // namespace

bool isConnectedTo(int socket, pid_t group) {
  sockaddr_in ours = {}, theirs = {};
  socklen_t size = sizeof ours, otherSize = sizeof theirs;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&ours), &size) != 0 ||
      ::getpeername(socket, reinterpret_cast<sockaddr*>(&theirs), &otherSize) != 0)
    return false;
  const std::optional<std::string> inode = inodeOf(theirs, ours);
  if (!inode) return true;
  if (*inode == "0") return false;
  std::error_code error;
  for (fs::directory_iterator process("/proc", error), end; !error && process != end; process.increment(error)) {
    const std::string name = process->path().filename();
    pid_t pid = 0;
    const auto [last, failure] = std::from_chars(name.data(), name.data() + name.size(), pid);
    if (failure != std::errc() || last != name.data() + name.size() || ::getpgid(pid) != group) continue;
    if (holds(process->path(), *inode)) return true;
  }
  return false;
}

}  // namespace spark::spades
