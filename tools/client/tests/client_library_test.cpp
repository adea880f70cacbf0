#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <stdexcept>

#include "spark/client/connection.h"
#include "spark/client/expression.h"

using namespace spark::client;

namespace {
/// The peer: a server with one client.
class Server {
 public:
  Server() {
    sockaddr_in self{};
    self.sin_family = AF_INET;
    self.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::bind(listener_, reinterpret_cast<sockaddr*>(&self), sizeof self) == 0);
    REQUIRE(::listen(listener_, 4) == 0);
    socklen_t n = sizeof self;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&self), &n);
    port = ntohs(self.sin_port);
  }
  ~Server() {
    leave();
    ::close(listener_);
  }
  void accept() { client_ = ::accept(listener_, nullptr, nullptr); }
  void send(const std::string& bytes) {
    REQUIRE(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size()));
  }
  std::string read(std::size_t n) {
    std::string bytes(n, ' ');
    REQUIRE(::recv(client_, bytes.data(), n, MSG_WAITALL) == static_cast<ssize_t>(n));
    return bytes;
  }
  void leave() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }
  int port = 0;

 private:
  int listener_ = ::socket(AF_INET, SOCK_STREAM, 0), client_ = -1;
};

std::string framed(const std::string& message) {
  return std::string{0, 0, static_cast<char>(message.size() >> 8), static_cast<char>(message.size())} + message;
}
}  // namespace

TEST_CASE("A client sends and receives whole messages with any segment boundaries") {
  Server server;
  Connection c("127.0.0.1", server.port, 600);
  server.accept();
  c.send("(syn)");
  CHECK(server.read(9) == framed("(syn)"));
  CHECK_FALSE(c.pending());
  CHECK_FALSE(c.receive(0));
  CHECK_FALSE(c.receive(0.001));
  const std::string all = framed("(a)") + framed("") + framed(std::string(300, 'x'));
  for (const char byte : all.substr(0, 5)) {
    server.send({byte});
    CHECK_FALSE(c.receive(0));
  }
  server.send(all.substr(5));
  CHECK(c.receive() == "(a)");
  CHECK(c.receive() == "");
  CHECK(c.receive(600) == std::string(300, 'x'));
  Connection moved = std::move(c);
  CHECK_FALSE(c.isOpen());
  server.send(framed("(b)"));
  CHECK(moved.receive() == "(b)");
  server.leave();
  CHECK_THROWS_AS(moved.receive(), Closed);
  CHECK_THROWS_WITH(moved.receive(), "the server closed the connection");
}

TEST_CASE("A server that leaves in the middle of a message is no end") {
  for (const std::size_t bytes : {1u, 4u, 6u}) {
    Server server;
    Connection c("127.0.0.1", server.port);
    server.accept();
    server.send(framed("(a)") + framed("(half)").substr(0, bytes));
    server.leave();
    CHECK(c.receive() == "(a)");
    try {
      c.receive();
      FAIL("nothing was thrown");
    } catch (const std::exception& e) {
      CHECK_FALSE(dynamic_cast<const Closed*>(&e));
      CHECK(e.what() == std::string("the server closed the connection in the middle of a message"));
    }
  }
}

TEST_CASE("A client reports errors of the server") {
  Server server;
  Connection c("127.0.0.1", server.port);
  server.accept();
  server.send("HTTP/1.1 400 Bad Request");
  CHECK_THROWS_WITH(c.receive(), Catch::Contains("it speaks another protocol"));
  int unused = 0;
  {
    Server gone;
    unused = gone.port;
  }
  CHECK_THROWS_WITH(Connection("127.0.0.1", unused), Catch::Contains("nobody can be reached at 127.0.0.1:"));
  CHECK_THROWS_WITH(Connection("127.0.0.1", 68828), Catch::Contains("expected a port from 1 to 65535, found 68828"));
  CHECK_THROWS_WITH(Connection("no.such.host.invalid", 3100),
                    Catch::Contains("there is no host 'no.such.host.invalid'"));
}

TEST_CASE("S-expressions are parsed into a tree") {
  const Expression all = read("(time (now 1.25)) (HJ (n hj1)(ax -12.50))(say \"a \\\" b\" x)");
  REQUIRE(all.size() == 3);
  CHECK(all.find("time").find("now")[1].number() == 1.25);
  CHECK(all[1].name() == "HJ");
  CHECK(all[1].find("ax")[1].number() == -12.5);
  CHECK(all[2][1].text() == "a \" b");
  CHECK(all[2][2].text() == "x");
  CHECK(all.find("none").size() == 0);
  CHECK(all.find("none")[1].number() == 0);
}

TEST_CASE("A syntax error ends a message, and what is complete before it is kept") {
  CHECK(read("(a 1)(b 2").size() == 1);
  CHECK(read("(a 1))(b 2)").size() == 1);
  CHECK(read("").size() == 0);
  CHECK(read("(a \"open").size() == 0);
  CHECK(read(std::string(100000, '(')).size() == 0);
  CHECK(read("(a 1)" + std::string(300, '(') + std::string(300, ')')).size() == 1);
}
