#pragma once
/// \file
/// The other end of a port in tests.

#include <string>
#include <vector>

#include "api/net.h"
#include "spark/describe.h"

namespace spark::test {

/// Logs what a port delivers.
class TestConsumer : public Node, public IConnectionConsumer {
  SPARK_CLASS(TestConsumer, Node)
 public:
  static void describe(Description<TestConsumer>& d) {
    d.doc("Logs what a port delivers.");
    d.implements<IConnectionConsumer>();
  }
  void connected(IConnection& c) override {
    connections.push_back(&c);
    events.push_back(fmt::format("+{}", c.id()));
  }
  void received(IConnection& c, std::string_view message) override {
    events.push_back(fmt::format("{}:{}", c.id(), message.size() > 40 ? "long" : message));
  }
  void disconnected(IConnection& c) override {
    std::erase(connections, &c);
    events.push_back(fmt::format("-{}", c.id()));
  }
  std::vector<IConnection*> connections;
  std::vector<std::string> events;
};

}  // namespace spark::test
