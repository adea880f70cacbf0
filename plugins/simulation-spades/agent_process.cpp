#include "agent_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "spark/error.h"
#include "tcp_agent.h"

namespace spark::spades {

namespace {
/// A descriptor that is closed at the end.
class Closing {
 public:
  explicit Closing(int descriptor) : descriptor_(descriptor) {}
  ~Closing() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Closing(const Closing&) = delete;
  Closing& operator=(const Closing&) = delete;
  int get() const { return descriptor_; }
  int release() { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
};

/// A pair of sockets for bytes in one direction, closed in programs that are started. Writing to a pipe raises SIGPIPE
/// once its reader has closed it; a socket need not.
struct SocketPair {
  explicit SocketPair(const std::array<int, 2>& ends = make()) : reads(ends[0]), writes(ends[1]) {}
  static std::array<int, 2> make() {
    std::array<int, 2> ends;
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw Error(fmt::format("cannot make a socket: {}", std::strerror(errno)));
    return ends;
  }
  Closing reads, writes;
};

/// A copy of a descriptor above all that an agent may want, so that assigning its own cannot overwrite it.
int copyAbove(const Closing& descriptor) {
  const int high = ::fcntl(descriptor.get(), F_DUPFD_CLOEXEC, 300);
  if (high < 0) throw Error(fmt::format("cannot copy a descriptor: {}", std::strerror(errno)));
  return high;
}
}  // namespace

std::unique_ptr<AgentLink> startAgent(const AgentType& type, int number, const std::string& log) {
  if (type.tcp) return std::make_unique<TcpAgent>(type, number, log);
  return std::make_unique<AgentProcess>(type, log);
}

AgentProcess::AgentProcess(const AgentType& type, const std::string& log) {
  SocketPair to, from;
  const Closing reads(copyAbove(to.reads)), writes(copyAbove(from.writes));
  program_ = std::make_unique<AgentProgram>(
      type, type.command, log, std::vector<AgentProgram::Descriptor>{{reads.get(), type.in}, {writes.get(), type.out}});
  pipes_ = std::make_unique<FrameStream>(from.reads.release(), to.writes.release());
}

void AgentProcess::send(std::string_view message) {
  if (beginsCycle(message)) program_->beginThought();
  pipes_->send(message);
}

std::optional<AgentLink::Message> AgentProcess::receive() {
  const auto text = pipes_->receive();
  if (!text) return std::nullopt;
  return program_->measured(std::string(*text));
}

}  // namespace spark::spades
