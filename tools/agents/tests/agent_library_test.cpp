#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <catch2/catch.hpp>
#include <thread>

#include "agent_connection.h"
#include "spark/error.h"
#include "test_support.h"

using namespace spark;
using namespace spark::agent;
namespace asio = boost::asio;
using asio::ip::tcp;

namespace {
/// A server for one client. It sends raw bytes and reads framed messages.
struct Server {
  asio::io_context io;
  tcp::acceptor acceptor{io, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  tcp::socket socket{io};
  int port() const { return acceptor.local_endpoint().port(); }
  void accept() { acceptor.accept(socket); }
  void send(const std::string& message) {
    std::string bytes{'\0', '\0', '\0', static_cast<char>(message.size())};
    asio::write(socket, asio::buffer(bytes + message));
  }
  std::string receive() {
    unsigned char prefix[4];
    asio::read(socket, asio::buffer(prefix));
    std::string body(static_cast<std::size_t>(prefix[2] << 8 | prefix[3]), ' ');
    asio::read(socket, asio::buffer(body));
    return body;
  }
};

std::string roundTrip(Language& language, const char* sexp) {
  Predicates in, back;
  readSexp(sexp, in);
  std::string message, out;
  language.write(in, message);
  language.read(message, back);
  writeSexp(back, 2, out);
  return out;
}
}  // namespace

TEST_CASE("Both message formats transmit the same predicates") {
  for (const char* parser : {"SexpParser", "JsonParser"}) {
    const auto language = makeLanguage(parser, {test::pluginFolder()});
    CAPTURE(parser);
    REQUIRE(roundTrip(*language, "(init (unum 7)(teamname Red))(syn)") ==
            roundTrip(*makeLanguage("SexpParser", {}), "(init (unum 7)(teamname Red))(syn)"));
  }
}

TEST_CASE("The JSON format is valid JSON on the wire") {
  const auto language = makeLanguage("JsonParser", {test::pluginFolder()});
  Predicates p;
  p.open("drive").add(1.5).add(0).close();
  std::string out;
  language->write(p, out);
  REQUIRE(out == "[[\"drive\",1.5000,0]]");
}

TEST_CASE("A message format without a plugin is an error that names it") {
  REQUIRE_THROWS_WITH(makeLanguage("MorseParser", {test::pluginFolder()}), Catch::Contains("MorseParser"));
}

TEST_CASE("An agent sends its first message, answers each message, and is notified of the end") {
  Server server;
  std::string first, second, why;
  asio::io_context io;
  const auto language = makeLanguage("SexpParser", {});
  AgentConnection agent(io, *language);
  std::thread peer([&] {
    server.accept();
    first = server.receive();
    server.send("(time (now 0.02))");
    second = server.receive();
    server.socket.close();
  });
  agent.connect("127.0.0.1", server.port());
  Predicates hello;
  hello.open("scene").add("x.rsg").close();
  double now = 0;
  agent.start(
      hello,
      [&](const Predicates& percepts, Predicates& actions) {
        for (const Element e : percepts)
          if (e.head() == "time") now = e.named("now").at(1).number();
        actions.open("syn").close();
      },
      [&](const std::string& reason) { why = reason; });
  io.run();
  peer.join();
  REQUIRE(first == "(scene x.rsg)");
  REQUIRE(second == "(syn )");
  REQUIRE(now == 0.02);
  REQUIRE(agent.received() == 1);
  REQUIRE(why == "the server closed the connection");
}

TEST_CASE("Split and combined messages are answered one by one, whether they are parsed or not") {
  const bool listens = GENERATE(true, false);
  Server server;
  std::vector<std::string> answers;
  asio::io_context io;
  const auto language = makeLanguage("SexpParser", {});
  AgentConnection agent(io, *language);
  agent.setListens(listens);
  std::thread peer([&] {
    server.accept();
    const std::string two("\0\0\0\3(a)\0\0\0\3(b)", 14);
    asio::write(server.socket, asio::buffer(two + std::string("\0\0", 2)));
    answers = {server.receive(), server.receive()};
    asio::write(server.socket, asio::buffer(std::string("\0\3(c", 4)));
    asio::write(server.socket, asio::buffer(std::string(")")));
    answers.push_back(server.receive());
    server.socket.close();
  });
  agent.connect("127.0.0.1", server.port());
  int count = 0;
  agent.start(
      {},
      [&](const Predicates& percepts, Predicates& actions) {
        actions.open(percepts.empty() ? "nothing" : (*percepts.begin()).head()).add(++count).close();
      },
      [](const std::string&) {});
  io.run();
  peer.join();
  if (listens)
    CHECK(answers == std::vector<std::string>{"(a 1)", "(b 2)", "(c 3)"});
  else
    CHECK(answers == std::vector<std::string>{"(nothing 1)", "(nothing 2)", "(nothing 3)"});
  CHECK(agent.received() == 3);
}

TEST_CASE("A peer with a different protocol ends the connection") {
  Server server;
  asio::io_context io;
  const auto language = makeLanguage("SexpParser", {});
  AgentConnection agent(io, *language);
  std::thread peer([&] {
    server.accept();
    asio::write(server.socket, asio::buffer(std::string("HTTP/1.1 400 Bad Request\r\n")));
  });
  agent.connect("127.0.0.1", server.port());
  std::string why;
  agent.start(
      {}, [](const Predicates&, Predicates&) {}, [&](const std::string& reason) { why = reason; });
  io.run();
  peer.join();
  REQUIRE(why.find("another protocol") != std::string::npos);
}

TEST_CASE("A refused connection is an error that names the address") {
  int port = 0;
  {
    Server server;
    port = server.port();
  }
  asio::io_context io;
  const auto language = makeLanguage("SexpParser", {});
  AgentConnection agent(io, *language);
  REQUIRE_THROWS_WITH(agent.connect("127.0.0.1", port), Catch::Contains("127.0.0.1:" + std::to_string(port)));
}
