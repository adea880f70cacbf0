#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "absence.h"
#include "spark/error.h"
#include "temporary_folder.h"
#include "test_support.h"

// Sinks that write in a thread of their own have written everything when they have been removed: no test waits.

using namespace spark;
using namespace spark::test;
using Catch::Contains;
using Catch::Matches;
namespace fs = std::filesystem;

namespace {
struct LogHost : TestHost {
  LogHost() { kernel.plugins().use("logserver"); }
  Leaf& make(const char* className) { return kernel.create(className, std::string("/sys/server/log/") + className); }
  static void remove(Leaf& leaf) { leaf.parent()->remove(leaf); }
};

std::string contents(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

List tail(Leaf& memory, std::vector<Value> arguments = {}) { return callMethod(memory, "tail", arguments).toList(); }

/// A UDP socket on a free port.
class Receiver {
 public:
  Receiver() : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in self{};
    self.sin_family = AF_INET;
    self.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(fd_, reinterpret_cast<sockaddr*>(&self), sizeof self);
    socklen_t size = sizeof self;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&self), &size);
    port = ntohs(self.sin_port);
  }
  ~Receiver() { ::close(fd_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;
  std::string receive() const {
    static char bytes[70000];
    const auto n = ::recv(fd_, bytes, sizeof bytes, 0);
    return n > 0 ? std::string(bytes, static_cast<std::size_t>(n)) : std::string();
  }
  int port = 0;

 private:
  int fd_;
};
}  // namespace

TEST_CASE("the log server sets the level of stderr at run time and counts errors") {
  LogHost h;
  Leaf& server = h.kernel.create("LogServer", "/sys/server/log");
  CHECK(getProperty(server, "level") == Value("info"));
  h.kernel.log().debug("one");
  setProperty(server, "level", "debug");
  h.kernel.log().debug("two");
  CHECK(h.text == "two\n");
  setProperty(server, "level", "off");
  h.kernel.log().error("three");
  CHECK(h.text == "two\n");
  CHECK(getProperty(server, "errors") == Value(1));
  CHECK_THROWS_WITH(setProperty(server, "level", "loud"), Contains("expected one of") && Contains("loud"));
}

TEST_CASE("each sink has a level of its own, which can change at run time") {
  LogHost h;
  Leaf& memory = h.make("MemoryLogSink");
  h.kernel.log().setLevel(Level::error);
  h.kernel.log().debug("one");
  h.kernel.log().info("two");
  setProperty(memory, "level", "debug");
  h.kernel.log().debug("three");
  setProperty(memory, "level", "off");
  h.kernel.log().error("four");
  const List lines = tail(memory);
  REQUIRE(lines.size() == 2);
  CHECK_THAT(lines[0].toString(),
             Matches("[0-9]{4}-[0-9]{2}-[0-9]{2} [0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]{3} info +two"));
  CHECK_THAT(lines[1].toString(), Contains(" debug ") && Contains("three"));
  CHECK(h.text == "four\n");
  CHECK(h.kernel.log().level() == Level::error);
}

TEST_CASE("a memory sink keeps the last messages") {
  LogHost h;
  Leaf& memory = h.make("MemoryLogSink");
  setProperty(memory, "capacity", 3);
  for (int i = 0; i < 5; ++i) h.kernel.log().info("line {}", i);
  REQUIRE(tail(memory).size() == 3);
  CHECK_THAT(tail(memory)[0].toString(), Contains("line 2"));
  REQUIRE(tail(memory, {2}).size() == 2);
  CHECK_THAT(tail(memory, {2})[1].toString(), Contains("line 4"));
  setProperty(memory, "capacity", 10);
  CHECK(tail(memory).empty());
}

TEST_CASE("a file sink continues its file, rotates it, and keeps a number of older ones") {
  LogHost h;
  TemporaryFolder folder;
  const fs::path file = folder.write("log.txt", "before\n");
  Leaf& sink = h.make("FileLogSink");
  setProperty(sink, "maxSize", 1000);
  setProperty(sink, "older", 2);
  setProperty(sink, "file", file.string());
  h.kernel.log().info("first");
  setProperty(sink, "file", "");  // it has been written then
  CHECK_THAT(contents(file), Matches("before\n[-0-9 :.]+ info +first\n"));
  h.kernel.log().info("lost");
  setProperty(sink, "file", file.string());
  const std::string without = contents(file);
  h.kernel.log().info("lost");
  setProperty(sink, "file", "");
  CHECK(lacks(without, "lost", contents(file)));
  const auto write = [&] {
    setProperty(sink, "file", file.string());
    for (int i = 0; i < 200; ++i) h.kernel.log().info("line {}", i);
    setProperty(sink, "file", "");
    CHECK_THAT(contents(file), Contains("line 199"));
    CHECK(fs::file_size(file) <= 1000);
    for (const char* name : {"log.1.txt", "log.2.txt"}) CHECK(fs::exists(folder.path() / name));
  };
  write();
  CHECK_FALSE(fs::exists(folder.path() / "log.3.txt"));
  setProperty(sink, "older", 3);
  write();
  CHECK(fs::exists(folder.path() / "log.3.txt"));
}

TEST_CASE("a file that cannot be opened is an error that names the sink and the file") {
  LogHost h;
  TemporaryFolder folder;
  Leaf& sink = h.make("FileLogSink");
  const std::string file = (fs::path(folder.write("plain", "")) / "log.txt").string();
  CHECK_THROWS_WITH(setProperty(sink, "file", file),
                    Contains("/sys/server/log/FileLogSink (FileLogSink) cannot be opened") && Contains(file));
  h.kernel.log().info("goes on");
  CHECK_THAT(h.text, Contains("goes on"));
}

TEST_CASE("a file sink takes only a regular file or a new one, and does not wait for the reader of a FIFO") {
  LogHost h;
  TemporaryFolder folder;
  Leaf& sink = h.make("FileLogSink");
  const auto refusal = [&](const std::string& file) {
    try {
      setProperty(sink, "file", file);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("it was accepted");
  };
  const std::string fifo = folder.file("fifo");
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  CHECK_THAT(refusal(fifo), Contains("/sys/server/log/FileLogSink (FileLogSink) cannot be opened") &&
                                Contains("expected a regular file or a new one, found a FIFO: " + fifo));
  CHECK_THAT(refusal(folder.path().string()), Contains("found a folder: "));
  CHECK_THAT(refusal("/dev/full"), Contains("found a device or terminal: /dev/full"));
  CHECK_THAT(refusal(folder.file("a") + std::string("\0b", 2)), Contains("expected a name without NUL bytes"));
  CHECK_FALSE(fs::exists(folder.path() / "a"));
  CHECK(refusal(folder.file("new.txt")) == "it was accepted");
  CHECK(fs::exists(folder.path() / "new.txt"));
}

TEST_CASE("a sink that cannot write says so once on stderr, with its path and what to do") {
  LogHost h;
  TemporaryFolder folder;
  const std::string file = folder.write("stderr.txt", "");
  std::fflush(stderr);
  const int before = ::dup(STDERR_FILENO), captured = ::open(file.c_str(), O_WRONLY);
  ::dup2(captured, STDERR_FILENO);
  Leaf& sink = h.make("UdpLogSink");
  setProperty(sink, "host", "255.255.255.255");  // the system refuses broadcasts
  setProperty(sink, "port", 9);
  for (int i = 0; i < 3; ++i) h.kernel.log().info("line {}", i);
  LogHost::remove(sink);
  std::fflush(stderr);
  ::dup2(before, STDERR_FILENO);
  ::close(before), ::close(captured);
  CHECK_THAT(contents(file),
             Matches("/sys/server/log/UdpLogSink \\(UdpLogSink\\) cannot write, and its messages are lost: "
                     ".*\\. Check host and port\\. This is reported once\\.\n"));
}

TEST_CASE("a UDP sink cuts a message that a datagram cannot hold, and marks it") {
  LogHost h;
  Receiver receiver;
  setProperty(h.make("UdpLogSink"), "port", receiver.port);
  std::string umlauts;
  for (int i = 0; i < 50000; ++i) umlauts += "\u00e4";
  h.kernel.log().info("a{}", umlauts);
  const std::string got = receiver.receive();
  CHECK(got.ends_with("\u00e4 ... (35002 bytes were cut)\n"));
  CHECK(got.size() < 65507);
}

TEST_CASE("a UDP sink sends each message to another program") {
  LogHost h;
  Receiver receiver;
  Leaf& sink = h.make("UdpLogSink");
  h.kernel.log().info("nowhere");
  setProperty(sink, "port", receiver.port);
  h.kernel.log().warning("hello");
  CHECK_THAT(receiver.receive(), Matches("[-0-9 :.]+ warning hello\n"));
  CHECK_THROWS_WITH(setProperty(sink, "host", "nowhere.else"),
                    Contains("cannot be opened") &&
                        Contains("host: expected an IPv4 address in numbers, such as 127.0.0.1, found 'nowhere.else'"));
}

TEST_CASE("nobody has to read what a UDP sink sends, and removed sinks get nothing") {
  LogHost h;
  int port = 0;
  {
    Receiver gone;
    port = gone.port;
  }
  Leaf& sink = h.make("UdpLogSink");
  setProperty(sink, "port", port);
  for (int i = 0; i < 10000; ++i) h.kernel.log().info("line {}", i);
  LogHost::remove(sink);
  h.kernel.log().info("last");
  CHECK_THAT(h.text, Contains("line 9999\nlast\n"));
}
