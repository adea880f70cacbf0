#include "tcp_entrance.h"

#include <fmt/format.h>
#include <unistd.h>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark::bench {

namespace {
constexpr std::int64_t kMaxConnections = 1100;

std::int64_t portOf(Kernel& kernel, const char* name) {
  return getProperty(kernel.root().require<Leaf>(fmt::format("/sys/server/net/{}", name)), "port").toInteger();
}
}  // namespace

void TcpEntrance::open(Kernel& kernel) {
  Node& root = kernel.root();
  setProperty(root.require<Leaf>("/sys/server/simulation"), "sync", true);
  setProperty(root.require<Leaf>("/sys/server/gamecontrol"), "joinPace", 0.0);
  setProperty(root.require<Leaf>("/sys/server/net/agents"), "maxConnections", kMaxConnections);
  callMethod(root.require<Leaf>("/sys/server/net"), "listen", {});
  command(fmt::format("open {} {}\n", portOf(kernel, "agents"), portOf(kernel, "monitors")));
}

void TcpEntrance::command(const std::string& text) {
  char answer = 0;
  if (write(line_, text.data(), text.size()) != static_cast<ssize_t>(text.size()) || read(line_, &answer, 1) != 1)
    throw Error("the process of the agents has ended");
}

}  // namespace spark::bench
