/// What agents and communication servers send: acts and requests, hellos, numbered frames.
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

#include "agent_mind.h"
#include "comm_channel.h"
#include "spark/error.h"

using namespace spark;
using namespace spark::spades;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);

  // An agent: a message per line, with time going on.
  const Latencies latencies;
  AgentMind mind(latencies);
  std::vector<Act> acts;
  Time now = 0;
  for (std::size_t at = 0; at < bytes.size(); ++now) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    if (mind.take(bytes.substr(at, end - at)) == AgentMind::Result::done) {
      mind.end(now % 7, acts);
      if (now % 3 == 0) (void)mind.inform();
    }
    if (now % 5 == 0) mind.sense(now, "x");
    (void)mind.next(now, {1, 0});
    at = end + 1;
  }

  try {
    (void)CommHello::read(bytes).write();
  } catch (const Error&) {
  }

  // A communication server that sends these bytes.
  int ends[2];
  if (size > 16384 || ::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 0;
  CommChannel channel;
  channel.send("kept");
  channel.attach(std::make_unique<FrameStream>(ends[0], ends[0]), 0);
  if (::write(ends[1], data, size) < 0) __builtin_trap();
  ::close(ends[1]);
  try {
    channel.poll();
    while (channel.receive()) {
    }
  } catch (const Error&) {
  }
  return 0;
}
