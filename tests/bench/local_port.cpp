#include "local_port.h"

#include "spark/error.h"
#include "spark/kernel.h"

namespace spark::bench {

LocalConnection::LocalConnection(Node& port, std::uint64_t id)
    : port_(port), id_(id), peer_(fmt::format("local:{}", id)) {}

bool LocalConnection::send(std::string_view message) {
  traffic.add(static_cast<std::int64_t>(message.size()));
  return true;
}

void LocalConnection::close(std::string_view reason) { throw Error(fmt::format("{} was closed: {}", peer_, reason)); }

void LocalPort::describe(Description<LocalPort>& d) {
  d.doc("Agents and a monitor within the process, for measurements.");
  d.implements<IInputSource>();
}

void LocalPort::admit(const World& world) {
  const std::size_t index = agents_.size();
  agents_.push_back(std::make_unique<Agent>(Agent{{*this, index + 1}, {world, index}}));
  kernel().root().require<IConnectionConsumer>("/sys/server/gamecontrol").connected(agents_.back()->connection);
}

void LocalPort::watch() {
  monitor_ = std::make_unique<LocalConnection>(*this, 0);
  kernel().root().require<IConnectionConsumer>("/sys/server/monitor").connected(*monitor_);
}

void LocalPort::poll() {
  if (agents_.empty()) return;
  auto& control = kernel().root().require<IConnectionConsumer>("/sys/server/gamecontrol");
  for (const auto& agent : agents_) {
    Agent& a = *agent;
    if (a.answered == a.connection.traffic.messages) continue;
    a.answered = a.connection.traffic.messages;
    control.received(a.connection, a.dialogue.say(a.received++));
  }
}

void LocalPort::resetTraffic() {
  for (const auto& agent : agents_) {
    agent->answered -= agent->connection.traffic.messages;
    agent->connection.traffic = {};
  }
  if (monitor_) monitor_->traffic = {};
}

Traffic LocalPort::percepts() const {
  Traffic sum;
  for (const auto& agent : agents_) {
    sum.messages += agent->connection.traffic.messages;
    sum.bytes += agent->connection.traffic.bytes;
    sum.longest = std::max(sum.longest, agent->connection.traffic.longest);
  }
  return sum;
}

}  // namespace spark::bench
