#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "api/unix_socket.h"
#include "arena.h"
#include "temporary_folder.h"
#include "test_consumer.h"

using namespace spark;
using namespace spark::test;

namespace {

struct Wire : Arena {
  TestConsumer* consumer;
  Wire() {
    kernel.registerClass<TestConsumer>();
    consumer = &kernel.create<TestConsumer>("TestConsumer", "/usr/consumer");
    setProperty(port(), "consumer", "/usr/consumer");
  }
  void waitForEvents(std::size_t n) {
    until([&] { return consumer->events.size() >= n; }, false);
  }
  using Events = std::vector<std::string>;
};

std::string framed(std::string_view message) {
  const auto n = htonl(static_cast<std::uint32_t>(message.size()));
  return std::string(reinterpret_cast<const char*>(&n), 4) + std::string(message);
}

}  // namespace

TEST_CASE("Messages are read from the stream with any segment boundaries") {
  Wire w;
  Client c = w.client();
  SECTION("several in one segment") { c.raw(framed("a") + framed("bc") + framed("") + framed("d")); }
  SECTION("byte by byte") {
    for (const char byte : framed("a") + framed("bc") + framed("") + framed("d")) {
      c.raw({&byte, 1});
      w.net->poll();
    }
  }
  w.waitForEvents(4);
  REQUIRE(w.consumer->events == Wire::Events{"+1", "1:a", "1:bc", "1:d"});
}

TEST_CASE("A line is a message, with any segment boundaries and either line end") {
  Wire w;
  Node& port = *w.port().asNode();
  port.remove(*port.find("framing"));
  w.kernel.create("LineFraming", port.path() + "/framing");
  setProperty(port, "maxMessage", 8);
  Client c = w.client();
  const std::string lines = "a\nb c\r\n\n12345678\r\nlast\n";
  const std::size_t segment = GENERATE(std::size_t(1), std::size_t(100));
  for (std::size_t at = 0; at < lines.size(); at += segment) {
    c.raw(std::string_view(lines).substr(at, segment));
    w.net->poll();
  }
  w.waitForEvents(5);
  REQUIRE(w.consumer->events == Wire::Events{"+1", "1:a", "1:b c", "1:12345678", "1:last"});
  SECTION("what is sent is one line") {
    REQUIRE(w.consumer->connections.front()->send("(a\n b)"));
    REQUIRE(c.receiveBytes(7) == "(a  b)\n");
  }
  SECTION("a longer line is refused, finished or not") {
    c.raw(GENERATE("123456789\n", "123456789"));
    REQUIRE(c.closed());
    REQUIRE_THAT(w.host.text, Catch::Contains("a line per message is expected"));
  }
}

TEST_CASE("A Unix socket is a port like any other") {
  Wire w;
  TemporaryFolder folder;
  const std::string file = folder.file("agents.sock");
  w.kernel.create("UnixPort", "/sys/server/net/local");
  w.kernel.create("LengthPrefixFraming", "/sys/server/net/local/framing");
  setProperty(w.port("local"), "consumer", "/usr/consumer");
  setProperty(w.port("local"), "file", file);
  SECTION("it delivers, sends, and knows the process of its client") {
    callMethod(w.port("local"), "listen", {});
    Client c(w, file);
    w.waitForEvents(1);
    REQUIRE(w.consumer->connections.front()->peer() == fmt::format("process {}", ::getpid()));
    c.send("hello");
    w.waitForEvents(2);
    REQUIRE(w.consumer->events == Wire::Events{"+1", "1:hello"});
    REQUIRE(w.consumer->connections.front()->send("answer"));
    REQUIRE(c.receive() == "answer");
  }
  SECTION("only its user can open it, it stays where it listens, and it is removed at the end") {
    callMethod(w.port("local"), "listen", {});
    struct stat found = {};
    REQUIRE(::stat(file.c_str(), &found) == 0);
    REQUIRE((found.st_mode & 0777) == 0600);
    const std::string elsewhere = folder.file("elsewhere.sock");
    REQUIRE_THROWS_WITH(setProperty(w.port("local"), "file", elsewhere),
                        Catch::Contains(fmt::format("it listens on {} already", file)));
    REQUIRE(getProperty(w.port("local"), "file").toString() == file);
    w.port("local").parent()->remove(w.port("local"));
    REQUIRE_FALSE(std::filesystem::exists(file));
  }
  SECTION("one that a dead program left is replaced") {
    ::close(listenAtUnixSocket(file));
    REQUIRE(std::filesystem::exists(file));
    callMethod(w.port("local"), "listen", {});
    Client c(w, file);
    w.waitForEvents(1);
  }
  SECTION("one in use, a file, and a name that is too long are errors that say so") {
    const auto listen = [&] {
      try {
        callMethod(w.port("local"), "listen", {});
        return std::string();
      } catch (const Error& e) {
        return std::string(e.what());
      }
    };
    const int other = listenAtUnixSocket(file);
    REQUIRE_THAT(listen(), Catch::Contains("cannot listen") && Catch::Contains("in use"));
    ::close(other);
    setProperty(w.port("local"), "file", folder.write("file", "text"));
    REQUIRE_THAT(listen(), Catch::Contains("in use"));
    setProperty(w.port("local"), "file", folder.file(std::string(200, 'x')));
    REQUIRE_THAT(listen(), Catch::Contains("1 to 107 bytes"));
    setProperty(w.port("local"), "file", "");
    REQUIRE_THAT(listen(), Catch::Contains("1 to 107 bytes"));
  }
}

TEST_CASE("Messages are delivered connection by connection in accept order, ports in tree order") {
  Wire w;
  w.addPort("second");
  setProperty(w.port("second"), "consumer", "/usr/consumer");
  Client late = w.client("second");
  w.waitForEvents(1);
  Client a = w.client();
  w.waitForEvents(2);
  Client b = w.client();
  w.waitForEvents(3);
  w.consumer->events.clear();
  late.send("3");
  b.send("2");
  a.send("1");
  w.waitForEvents(3);
  REQUIRE(w.consumer->events == Wire::Events{"1:1", "2:2", "1:3"});
}

TEST_CASE("A length over the limit closes only its own connection, with one log line") {
  Wire w;
  Client good = w.client();
  Client bad = w.client();
  const std::string prefix = GENERATE(std::string("\x80\0\0\0", 4), std::string("\xff\xff\xff\xff", 4),
                                      std::string("\0\x01\0\x01", 4), std::string("GET / HTTP/1.1\r\n"));
  bad.raw(prefix);
  REQUIRE(bad.closed());
  REQUIRE(w.logged(bad.name() + " is closed: it announces a message of"));
  good.send("still here");
  w.until([&] { return w.consumer->events.back() == "1:still here"; }, false);
  REQUIRE(w.consumer->connections.size() == 1);
}

TEST_CASE("A message of the maximum length is accepted") {
  Wire w;
  Client c = w.client();
  c.send(std::string(65536, 'x'));
  w.waitForEvents(2);
  REQUIRE(w.consumer->events.back() == "1:long");
}

TEST_CASE("A client that sends part of a message and then nothing is closed after messageTimeout") {
  Wire w;
  setProperty(w.port(), "messageTimeout", 0.01);
  Client c = w.client();
  c.raw(framed("0123456789").substr(0, 9));
  REQUIRE(c.closed());
  REQUIRE(w.logged("it began a message and did not finish it within 0.01 s"));
}

TEST_CASE("A client that sends its message in drips is closed after messageTimeout, counted from the first byte") {
  Wire w;
  setProperty(w.port(), "messageTimeout", 0.05);
  Client c = w.client();
  const std::string message = framed(std::string(60000, 'x'));
  const auto start = std::chrono::steady_clock::now();
  // Drips come much faster than the limit, and the message would take a minute.
  for (std::size_t at = 0; at < message.size() && !w.logged("did not finish it within 0.05 s"); ++at) {
    c.raw(std::string_view(message).substr(at, 1));
    w.net->poll();
    const auto next = start + std::chrono::milliseconds(at + 1);
    while (std::chrono::steady_clock::now() < next) w.net->poll();
  }
  CHECK(w.consumer->events.size() <= 2);
  REQUIRE(w.logged("it began a message and did not finish it within 0.05 s"));
  REQUIRE(c.closed());
}

TEST_CASE("When its consumer is removed a port closes its clients with one log line, and serves the next consumer") {
  Wire w;
  Client silent = w.client(), speaker = w.client();
  w.waitForEvents(2);
  speaker.send("too late");
  Node& usr = w.kernel.root().require<Node>("/usr");
  usr.remove(*usr.find("consumer"));
  REQUIRE(silent.closed());
  REQUIRE(speaker.closed());
  REQUIRE(w.logged("/usr/consumer was removed, all clients are closed."));
  Client refused = w.client();
  REQUIRE(refused.closed());
  w.consumer = &w.kernel.create<TestConsumer>("TestConsumer", "/usr/consumer");
  Client next = w.client();
  next.send("hello");
  w.until([&] { return !w.consumer->events.empty() && w.consumer->events.back().ends_with(":hello"); }, false);
}

TEST_CASE("A client that only waits is not closed") {
  Wire w;
  setProperty(w.port(), "messageTimeout", 0.01);
  Client c = w.client();
  c.send("a");
  Client half = w.client();
  half.raw(std::string(2, '\0'));
  REQUIRE(half.closed());
  c.send("b");
  w.until([&] { return w.consumer->events.back() == "1:b"; }, false);
}

TEST_CASE("A disconnect in the middle of a message is reported and logged") {
  Wire w;
  {
    Client c = w.client();
    c.raw(framed("whole") + framed("0123456789").substr(0, 8));
    w.waitForEvents(2);
  }
  w.waitForEvents(3);
  REQUIRE(w.consumer->events == Wire::Events{"+1", "1:whole", "-1"});
  REQUIRE(w.logged("left in the middle of a message"));
}

TEST_CASE("Messages sent before a disconnect are delivered") {
  Wire w;
  {
    Client c = w.client();
    c.send("last words");
  }
  w.waitForEvents(3);
  REQUIRE(w.consumer->events == Wire::Events{"+1", "1:last words", "-1"});
}

TEST_CASE("The server survives 200 clients that connect and disconnect") {
  Wire w;
  for (int i = 0; i < 200; ++i) {
    Client c = w.client();
    c.send("x");
    if (i % 7 == 0) w.net->poll();
  }
  w.until(
      [&] {
        return w.consumer->connections.empty() && getProperty(w.port(), "connections").toInteger() == 0 &&
               w.consumer->events.size() > 3;
      },
      false);
  Client c = w.client();
  c.send("match goes on");
  w.until([&] { return w.consumer->events.back().ends_with(":match goes on"); }, false);
}

TEST_CASE("A client above maxConnections is closed with a log line") {
  Wire w;
  setProperty(w.port(), "maxConnections", 2);
  Client a = w.client(), b = w.client(), c = w.client();
  REQUIRE(c.closed());
  REQUIRE(w.logged("2 clients are connected already (maxConnections)"));
  REQUIRE(w.consumer->connections.size() == 2);
  a.leave();
  w.until([&] { return w.consumer->connections.size() == 1; }, false);
  Client d = w.client();
  w.until([&] { return w.consumer->connections.size() == 2; }, false);
}

TEST_CASE("A client that does not read still gets whole messages, and newer ones are dropped and counted") {
  Wire w;
  Client c = w.client();
  w.waitForEvents(1);
  IConnection& connection = *w.consumer->connections[0];
  int sent = 0, dropped = 0;
  while (dropped < 50) {
    const bool left = connection.send(fmt::format("{:06}", sent) + std::string(60000, 'x'));
    ++(left ? sent : dropped);
    REQUIRE(sent < 10000);
  }
  REQUIRE_FALSE(connection.idle());
  REQUIRE(connection.stalledSeconds() > 0);
  REQUIRE(getProperty(w.port(), "messagesDropped").toInteger() == 50);
  for (int i = 0; i < sent; ++i) {
    const auto message = c.receive();
    REQUIRE(message);
    REQUIRE(message->size() == 60006);
    REQUIRE(message->substr(0, 6) == fmt::format("{:06}", i));
  }
  w.until([&] { return connection.idle(); }, false);
  REQUIRE(connection.stalledSeconds() == 0);
  REQUIRE(connection.send("again"));
  REQUIRE(c.receive() == "again");
}

namespace {
/// Sends to a connection until the client's buffers are full.
void fill(IConnection& connection) {
  while (connection.idle()) REQUIRE(connection.send(std::string(60000, 'x')));
}

/// The server's end of a client's connection; both are in one process.
int serverEnd(const Client& client) {
  for (int fd = 3; fd < 1024; ++fd) {
    sockaddr_in peer{};
    socklen_t n = sizeof peer;
    if (::getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &n) == 0 &&
        "127.0.0.1:" + std::to_string(ntohs(peer.sin_port)) == client.name())
      return fd;
  }
  return -1;
}

int option(int fd, int level, int name) {
  int value = -1;
  socklen_t n = sizeof value;
  REQUIRE(::getsockopt(fd, level, name, &value, &n) == 0);
  return value;
}
}  // namespace

TEST_CASE("TCP keep-alive detects clients whose machine has failed and keeps clients that merely do not read") {
  Wire w;
  Client c = w.client();
  w.waitForEvents(1);
  const int fd = serverEnd(c);
  REQUIRE(fd >= 0);
  CHECK(option(fd, SOL_SOCKET, SO_KEEPALIVE) == 1);
  CHECK(option(fd, IPPROTO_TCP, TCP_KEEPIDLE) == 30);
  CHECK(option(fd, IPPROTO_TCP, TCP_KEEPINTVL) == 10);
  CHECK(option(fd, IPPROTO_TCP, TCP_KEEPCNT) == 6);
  CHECK(option(fd, IPPROTO_TCP, TCP_USER_TIMEOUT) == 0);
}

TEST_CASE("On a full port the client that neither reads nor sends for longest is closed, and readers stay") {
  Wire w;
  setProperty(w.port(), "maxConnections", 4);
  Client reader = w.client(), sender = w.client(), mute = w.client(), mute2 = w.client();
  w.waitForEvents(4);
  const auto connections = w.consumer->connections;
  sender.send("command");
  w.waitForEvents(5);
  for (std::size_t i = 1; i < 4; ++i) fill(*connections[i]);
  const auto knock = [&] {
    const auto seen = w.consumer->events.size();
    Client c = w.client();
    w.until(
        [&] {
          return w.consumer->events.size() > seen || c.drain().size() > 0 ||
                 w.logged(c.name() + " is closed: 4 clients are connected already");
        },
        false);
    return std::pair(std::move(c),
                     std::vector<std::string>(w.consumer->events.begin() + static_cast<std::ptrdiff_t>(seen),
                                              w.consumer->events.end()));
  };

  SECTION("no client is closed by default") { REQUIRE(knock().second.empty()); }
  SECTION("no client is closed before makeRoomAfter") {
    setProperty(w.port(), "makeRoomAfter", 1e6);
    REQUIRE(knock().second.empty());
  }
  SECTION("clients that never sent anything are closed first") {
    setProperty(w.port(), "makeRoomAfter", 1e-9);
    std::vector<Client> guests;
    for (const char* gone : {"-3", "-4", "-2"}) {
      auto [guest, events] = knock();
      guests.push_back(std::move(guest));
      w.until(
          [&] {
            return std::find(w.consumer->events.begin(), w.consumer->events.end(), gone) != w.consumer->events.end();
          },
          false);
    }
    CHECK(w.logged(mute.name() + " is closed: it said nothing, and its place is needed."));
    CHECK(w.logged(sender.name() + " is closed: it neither reads nor sends, and its place is needed."));
    REQUIRE(knock().second.empty());  // all remaining clients read
    reader.send("still here");
    w.until([&] { return w.consumer->events.back() == "1:still here"; }, false);
  }
}

TEST_CASE("A flood from one client does not delay the others") {
  Wire w;
  Client flood = w.client();
  w.waitForEvents(1);
  Client other = w.client();
  w.waitForEvents(2);
  std::string bytes;
  for (int i = 0; i < 400000; ++i) bytes += framed("xx");
  other.send("hello");
  std::string_view rest = bytes;
  bool heard = false;
  // The poll that reads the flood also reads the other client's message.
  flood.raw(rest.substr(0, 65536));
  for (int polls = 0; polls < 100 && !heard; ++polls) {
    w.net->poll();
    heard = std::find(w.consumer->events.begin(), w.consumer->events.end(), "2:hello") != w.consumer->events.end();
  }
  REQUIRE(heard);
}

TEST_CASE("A closed connection delivers nothing more and is reported once") {
  Wire w;
  Client c = w.client();
  w.waitForEvents(1);
  c.send("a");
  w.consumer->connections[0]->close("the test says so");
  w.net->poll();
  REQUIRE(w.consumer->events == Wire::Events{"+1", "-1"});
  REQUIRE(w.logged("is closed: the test says so."));
}

TEST_CASE("Waiting ends with input, at the deadline, and on a stop request") {
  Wire w;
  REQUIRE_FALSE(w.net->wait(0.01));
  Client c = w.client();
  c.send("a");
  while (w.consumer->events.size() < 2) REQUIRE(w.net->wait(3600));
  w.kernel.requestStop();
  REQUIRE(w.net->wait(3600));
}

TEST_CASE("A port that cannot listen is an error that says why") {
  Wire w;
  const auto listen = [&](const std::string& name) {
    try {
      callMethod(w.port(name), "listen", {});
      return std::string();
    } catch (const Error& e) {
      return std::string(e.what());
    }
  };
  w.addPort("twin");
  setProperty(w.port("twin"), "port", w.portNumber());
  REQUIRE_THAT(listen("twin"),
               Catch::Contains("cannot") && Catch::Contains("in use") && Catch::Contains("0 picks a free one"));
  w.addPort("astray");
  setProperty(w.port("astray"), "consumer", "/usr/nobody");
  REQUIRE_THAT(listen("astray"), Catch::Contains("/usr/nobody"));
  setProperty(w.port("astray"), "consumer", "/usr/consumer");
  setProperty(w.port("astray"), "address", "somewhere");
  REQUIRE_THAT(listen("astray"), Catch::Contains("expected an IP address"));
  w.kernel.create("TcpPort", "/sys/server/net/bare");
  REQUIRE_THAT(listen("bare"), Catch::Contains("has no framing"));
  REQUIRE_THROWS_WITH(setProperty(w.port(), "port", 1), Catch::Contains("listens on"));
}

TEST_CASE("The network server can be taken down with clients connected") {
  Wire w;
  Client c = w.client();
  w.waitForEvents(1);
  Node& servers = w.kernel.root().require<Node>("/sys/server");
  w.port().parent()->remove(w.port());
  REQUIRE(w.consumer->events == Wire::Events{"+1", "-1"});
  servers.remove(*servers.find("net"));
}
