#include <sys/socket.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "../comm_channel.h"
#include "spark/error.h"

using namespace spark;
using namespace spark::spades;

namespace {

/// Both ends of a conversation, and the connection between them.
struct Pair {
  CommChannel a, b;
  Pair() {
    std::signal(SIGPIPE, SIG_IGN);
    connect();
  }
  void connect() {
    int ends[2];
    REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0);
    auto one = std::make_unique<FrameStream>(ends[0], ends[0]), other = std::make_unique<FrameStream>(ends[1], ends[1]);
    const auto ofA = a.received(), ofB = b.received();
    a.attach(std::move(one), ofB);
    b.attach(std::move(other), ofA);
  }
};

std::vector<std::string> all(CommChannel& c) {
  std::vector<std::string> out;
  c.poll();
  while (auto m = c.receive()) out.push_back(*m);
  return out;
}

}  // namespace

TEST_CASE("a conversation goes on after its connection broke: no message is lost or comes twice") {
  Pair p;
  std::vector<std::string> sent, got;
  int number = 0;
  for (int connection = 0; connection < 20; ++connection) {
    for (int i = 0; i < 1 + connection * 7 % 40; ++i) {
      sent.push_back(std::to_string(number++));
      p.a.send(sent.back());
      if (i % 3 == 0) p.b.send("answer");
    }
    if (connection % 3 == 0) p.a.poll();
    if (connection % 2 == 0)
      for (auto& m : all(p.b)) got.push_back(std::move(m));
    // It breaks: at one end, at the other, or at both.
    if (connection % 4 != 1) p.a.close("cut");
    if (connection % 4 != 2) p.b.close("cut");
    p.a.send(sent.emplace_back("while it is cut " + std::to_string(number++)));
    p.connect();
  }
  for (auto& m : all(p.b)) got.push_back(std::move(m));
  REQUIRE(got == sent);
}

TEST_CASE("what the other side has received is kept no longer") {
  Pair p;
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 100; ++i) p.a.send("x");
    REQUIRE(all(p.b).size() == 100);
    p.a.poll();
  }
  // Of 10000 messages only those since the last acknowledgement are sent again.
  p.connect();
  std::size_t frames = 0;
  p.b.poll();
  while (p.b.receive()) ++frames;
  REQUIRE(frames == 0);
}

TEST_CASE("a hello is read as it was written, and another program is refused with what was expected") {
  CommHello hello;
  hello.session = std::string(32, 'a');
  hello.received = 7;
  hello.token = "secret";
  hello.name = "lab";
  hello.types = {{"red", "fixed 3"}, {"blue", ""}};
  const CommHello read = CommHello::read(hello.write());
  REQUIRE(read.write() == hello.write());
  REQUIRE(read.types == hello.types);
  REQUIRE_THROWS_WITH(CommHello::read("GET / HTTP/1.1"), Catch::Contains("expected a communication server of version"));
  REQUIRE_THROWS_WITH(CommHello::read("spark-comm 2\nshort\n0\n\n"), Catch::Contains("session"));
  REQUIRE_THROWS_WITH(CommHello::read("spark-comm 2\n" + std::string(32, 'a') + "\nmany\n"), Catch::Contains("number"));
}
