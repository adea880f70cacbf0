#include <catch2/catch.hpp>

#include "allocations.h"
#include "stage.h"

using namespace spark;
using namespace spark::test;

namespace {
/// A client that accepts every message at once and stores nothing.
class Sink : public IConnection {
 public:
  explicit Sink(Node& port) : port_(port) {}
  std::uint64_t id() const override { return 1; }
  const std::string& peer() const override { return peer_; }
  Node& port() override { return port_; }
  bool send(std::string_view message) override {
    bytes += message.size();
    return true;
  }
  bool idle() const override { return true; }
  double stalledSeconds() const override { return 0; }
  void close(std::string_view) override {}
  std::size_t bytes = 0;

 private:
  Node& port_;
  std::string peer_ = "sink";
};
}  // namespace

TEST_CASE("frames, diffs, events and full messages for several clients allocate nothing in steady state") {
  Stage stage;
  stage.kernel.log().setLevel(Level::warning);
  Sink sinks[] = {Sink(*stage.port), Sink(*stage.port), Sink(*stage.port)};
  for (Sink& sink : sinks) stage.monitor->connected(sink);
  const auto play = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      stage.item->score = i / 7;
      stage.item->waiting = i % 5 == 0;
      stage.head->shown = (i / 3) % 2;
      if (i % 50 == 0) stage.server->requestFullState();
      stage.cycle();
    }
  };
  play(400);
  const std::size_t before = sinks[0].bytes;
  CHECK(Allocations::in([&] { play(1000); }) == 0);
  CHECK(sinks[0].bytes > before + 50000);
  CHECK(sinks[2].bytes == sinks[0].bytes);
}
