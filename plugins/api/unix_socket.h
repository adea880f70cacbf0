#pragma once
/// \file
/// Unix sockets: how all plugins open theirs.

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "spark/abi/api/unix_socket.h"
#include "spark/error.h"

namespace spark {

namespace unix_socket {

/// The address of a file. Throws Error if it is empty or too long.
inline sockaddr_un addressOf(const std::string& file) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (file.empty() || file.size() >= sizeof address.sun_path)
    throw Error(fmt::format("expected a file name of 1 to {} bytes for a Unix socket, found {}: '{}'",
                            sizeof address.sun_path - 1, file.size(), file));
  std::memcpy(address.sun_path, file.data(), file.size());
  return address;
}

/// True if `file` is a socket whose program is gone. A datagram socket cannot connect to a stream socket, but the
/// system tells whether there is one: the other program notices nothing.
inline bool isAbandoned(const std::string& file) {
  struct stat found = {};
  if (::lstat(file.c_str(), &found) != 0 || !S_ISSOCK(found.st_mode)) return false;
  const sockaddr_un address = addressOf(file);
  const int knock = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool refused =
      ::connect(knock, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 && errno == ECONNREFUSED;
  ::close(knock);
  return refused;
}

}  // namespace unix_socket

/// Listens at a Unix socket that only this user can open; replaces one that a program has left behind. Returns its
/// descriptor, which the caller closes. Throws Error.
inline int listenAtUnixSocket(const std::string& file) {
  const sockaddr_un address = unix_socket::addressOf(file);
  if (unix_socket::isAbandoned(file)) ::unlink(file.c_str());
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // The file takes the mode of the descriptor: there is no instant at which others can open it.
  if (descriptor >= 0 && ::fchmod(descriptor, 0600) == 0 &&
      ::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(descriptor, SOMAXCONN) == 0)
    return descriptor;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  throw Error(
      fmt::format("cannot listen at the Unix socket '{}': {}. Choose another file.", file, std::strerror(error)));
}

/// The process at the other end of a connected Unix socket; 0 if unknown.
inline int peerProcess(int descriptor) {
  ucred peer = {};
  socklen_t size = sizeof peer;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 ? static_cast<int>(peer.pid) : 0;
}

}  // namespace spark
