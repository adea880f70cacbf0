#include "net-tcp/unix_port.h"

#include <unistd.h>

#include <filesystem>

#include "api/unix_socket.h"
#include "spark/error.h"

namespace spark {

void UnixPort::describe(Description<UnixPort>& d) {
  d.doc(
      "A Unix socket for clients of this machine and user; splits input into messages with the framing below it and "
      "delivers them to its consumer.");
  d.property("file", &UnixPort::file, &UnixPort::setFile)
      .ofProcess()
      .doc("File of the socket, which is made when it listens and removed at the end.");
}

void UnixPort::setFile(std::string file) {
  if (listening() && file != file_)
    throw Error(fmt::format("{}.file: it listens on {} already. Set the file before listen().", path(), file_));
  file_ = std::move(file);
}

void UnixPort::open(Acceptor& acceptor) {
  try {
    acceptor.assign(net::Stream(AF_UNIX, 0), listenAtUnixSocket(file_));
    bound_ = std::filesystem::absolute(file_).string();
    acceptor.non_blocking(true);
  } catch (const std::exception& e) {
    throw Error(fmt::format("{} cannot listen", path()), e);
  }
}

void UnixPort::closed() { ::unlink(bound_.c_str()); }

StreamPort::Accepted UnixPort::accepted(net::Stream::socket socket) const {
  const int process = peerProcess(socket.native_handle());
  return {std::move(socket), process > 0 ? fmt::format("process {}", process) : std::string("(gone)")};
}

}  // namespace spark
