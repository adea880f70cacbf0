#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "absence.h"
#include "attack.h"
#include "temporary_folder.h"
#include "web_client.h"

// Bad input to the web port of a host with a running match. After every attack a well-behaved player still sees time
// advance, and a viewer still gets frames.

using namespace spark::test;
using Catch::Contains;

namespace {

/// Sets the web server's wall-clock limits to an hour. Options in `more` follow, so a test can override them.
std::vector<std::string> withoutWebLimits(const std::vector<std::string>& more) {
  std::vector<std::string> all{"--set", "/sys/server/web.requestTimeout=3600", "--set",
                               "/sys/server/web.stallTimeout=3600"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// An arena with a connected viewer.
struct WatchedArena : Arena {
  explicit WatchedArena(const std::vector<std::string>& more = {}) : Arena(withoutWebLimits(more)) { connectViewer(); }
  /// Connects the viewer. Retries, because the viewer may be too slow for a short time limit of the test.
  void connectViewer() {
    for (bool connected = false; !connected;) {
      try {
        viewer.emplace(webPort);
        REQUIRE(viewer->watch() == 101);
        viewer->binary();
        connected = true;
      } catch (const boost::system::system_error&) {
      }
    }
  }
  /// Reads all frames that have arrived. Call it regularly, so that the viewer answers pings and its buffers do not
  /// fill up.
  void readFrames() {
    while (viewer->pending()) viewer->next();
  }
  /// Checks that the player and the viewer are not affected.
  void mustContinue() {
    witness->mustSeeTimePass();
    readFrames();
    viewer->binary();
    viewer->binary();
  }
  WebClient client() {
    readFrames();
    return WebClient(webPort);
  }
  std::optional<WebClient> viewer;
};

std::string local(const WatchedArena& s) { return "Host: 127.0.0.1:" + std::to_string(s.webPort) + "\r\n"; }
}  // namespace

TEST_CASE("No path reaches files outside of the served folders") {
  const TemporaryFolder folder;
  folder.write("served/game.log", "a game");
  folder.write("secret.log", "root: no secret");
  WatchedArena s({"--set", "webLogs=" + folder.file("served")});
  const WebClient::Answer game = s.client().get("/logs/game.log");
  REQUIRE(game.status == 200);
  CHECK(game.body == "a game");
  for (const char* target : {"/../../../../etc/passwd",
                             "/logs/../../../etc/passwd",
                             "/logs/..%2f..%2f..%2fetc%2fpasswd",
                             "/logs/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
                             "/logs//etc/passwd",
                             "/logs/..\\..\\etc\\passwd",
                             "/logs/.hidden",
                             "/logs/../secret.log",
                             "/logs/..%2fsecret.log",
                             "/logs/",
                             "/logs/.",
                             "/assets/../../lua/house.lua",
                             "/%2e%2e/lua/house.lua",
                             "/logs/game.log%00.txt",
                             "/logs/%",
                             "/logs/%4",
                             "/./index.html",
                             "//etc/passwd",
                             "/logs/a/b/c/d/e/f",
                             "/index.html/"}) {
    INFO(target);
    const WebClient::Answer answer = s.client().get(target);
    CHECK(answer.status == 404);
    CHECK(lacks(answer.body, "root:", textOf(folder.file("secret.log"))));
    CHECK(lacks(answer.body, "function", textOf(SPARK_SOURCES "/lua/house.lua")));
  }
  for (const char* target : {"http://127.0.0.1/", "index.html", "*", "\\..\\x"})
    CHECK(s.client().get(target).status == 400);
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE(
    "Oversized headers, bodies, unknown methods and bytes that are not HTTP are refused and close the connection") {
  WatchedArena s;
  const std::vector<std::pair<std::string, int>> requests{
      {"GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n" + local(s) + "\r\n", 431},
      {"GET / HTTP/1.1\r\n" + local(s) + "X: " + std::string(20000, 'a') + "\r\n\r\n", 431},
      {"GET / HTTP/1.1\r\n" + local(s) + "Content-Length: 5\r\n\r\nhello", 413},
      {"GET / HTTP/1.1\r\n" + local(s) + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n", 413},
      {"POST /status.json HTTP/1.1\r\n" + local(s) + "\r\n", 405},
      {"(scene rsg/agent/sphere.rsg)\r\n\r\n", 400},
      {std::string("\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03", 11) + "\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\n" + local(s) + "Content-Length: 99999999999999999999\r\n\r\n", 400},
  };
  for (const auto& [request, status] : requests) {
    INFO(request.substr(0, 60));
    s.readFrames();
    WebClient client(s.webPort);
    client.sendRaw(request);
    CHECK_THAT(client.waitForClose(), Catch::StartsWith("HTTP/1.1 " + std::to_string(status)));
  }
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("A client that sends its request too slowly, or none, is closed") {
  WatchedArena s({"--set", "/sys/server/web.requestTimeout=0.5"});
  WebClient silent(s.webPort), slow(s.webPort);
  slow.sendRaw("GET / HTTP/1.1\r\nHost: ");
  slow.sendRaw("localhost\r\nX-A: b\r\n");
  slow.waitForClose();
  silent.waitForClose();
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("Foreign host names and origins are refused, and a forwarded port is accepted") {
  WatchedArena s({"--set", "/sys/server/web.hosts={\"match.example\"}"});
  const auto page = [&](const std::string& host) { return s.client().get("/", "Host: " + host + "\r\n").status; };
  for (const char* ours : {"localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]:3280", "192.168.0.7:3280",
                           "x.localhost", "match.example:80"})
    CHECK(page(ours) == 200);
  for (const char* strange :
       {"evil.example", "evil.example:3280", "127.0.0.1.evil.example", "localhost.evil.example", "[evil]", "", ":3280"})
    CHECK(page(strange) == 421);
  CHECK(s.client().get("/", "X: y\r\n").status == 421);
  CHECK(s.client().get("/", "Host: localhost\r\nHost: localhost\r\n").status == 421);

  const auto stream = [&](const std::string& host, const std::string& origin) {
    return s.client().get("/stream", WebClient::upgrade("Host: " + host + "\r\nOrigin: " + origin + "\r\n")).status;
  };
  CHECK(stream("localhost:8080", "http://localhost:8080") == 101);
  CHECK(stream("match.example", "https://match.example") == 101);
  for (const char* origin : {"http://evil.example", "http://localhost", "http://localhost:8081", "null", "",
                             "http://localhost:8080.evil.example", "file://localhost:8080"})
    CHECK(stream("localhost:8080", origin) == (*origin ? 403 : 101));
  CHECK(stream("evil.example", "http://evil.example") == 421);
  CHECK(s.client().get("/stream").status == 426);
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("Frames that violate the WebSocket protocol and oversized messages close their connection") {
  WatchedArena s;
  const std::string invalid("\xff\xfe", 2);
  std::string huge = WebClient::frame("x");
  huge.replace(1, 1, std::string("\xff\x7f\xff\xff\xff\xff\xff\xff\xff", 9));
  const std::vector<std::pair<const char*, std::string>> attacks{
      {"no mask", WebClient::frame("{}", 1, false)},
      {"reserved bits", std::string("\xf1") + WebClient::frame("{}").substr(1)},
      {"unknown kind", WebClient::frame("{}", 3)},
      {"unknown control", WebClient::frame("{}", 0xb)},
      {"no UTF-8", WebClient::frame(invalid)},
      {"too long", WebClient::frame(std::string(20000, ' '))},
      {"announced", huge},
      {"long ping", WebClient::frame(std::string(200, 'x'), 9)},
      {"rest of nothing", WebClient::frame("{}", 0)},
      {"ping in pieces", WebClient::frame("x", 9, true, false)},
      {"binary", WebClient::frame("{}", 2)},
      {"HTTP", "GET / HTTP/1.1\r\n\r\n"},
      {"in too many pieces",
       WebClient::frame(std::string(10000, ' '), 1, true, false) + WebClient::frame(std::string(10000, ' '), 0)},
  };
  for (const auto& [what, bytes] : attacks) {
    INFO(what);
    s.readFrames();
    WebClient bad(s.webPort);
    REQUIRE(bad.watch() == 101);
    bad.sendRaw(bytes);
    bad.waitForClose();
  }
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("Invalid messages are answered with an error, and too many of them close the connection") {
  WatchedArena s;
  for (const std::string& message :
       {std::string("hello"), std::string("[]"), std::string("{}"), std::string("{\"do\":7}"),
        std::string("{\"do\":\"get\"}"), std::string(16000, '['), std::string("{\"do\":\"view\",\"rate\":\"many\"}"),
        std::string("{\"do\":\"fly\",\"id\":1}"), std::string("{\"do\":\"get\",\"id\":1,\"path\":7}"),
        std::string("{\"do\":\"get\",\"id\":1,\"path\":\"/nowhere\"}")}) {
    INFO(message.substr(0, 60));
    s.readFrames();
    WebClient client(s.webPort);
    REQUIRE(client.watch() == 101);
    client.say(message);
    CHECK_THAT(client.textWith("\"answer\""), Contains("\"ok\":false"));
  }
  for (const int opcode : {1, 9}) {
    s.readFrames();
    WebClient flood(s.webPort);
    REQUIRE(flood.watch() == 101);
    std::string many;
    for (int i = 0; i < 2000; ++i) many += WebClient::frame("{\"do\":\"view\"}", opcode);
    flood.sendRaw(many);
    flood.waitForClose();
    s.host.waitForError("too many messages");
  }
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("Only the token grants referee rights, and it can be neither guessed nor read") {
  // The name of a folder has the token, so that the token is found where the server's properties are read.
  const std::string token = "a-token-of-the-test";
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file(token));
  WatchedArena s({"--set", "webToken=" + token, "--set", "webLogs=" + folder.file(token)});
  WebClient spectator(s.webPort);
  REQUIRE(spectator.watch() == 101);
  const auto refused = [&](const std::string& message) {
    spectator.say(message);
    CHECK_THAT(spectator.textWith("\"answer\""), Contains("\"ok\":false") && Contains("referee"));
  };
  refused(R"~({"do":"command","id":1,"text":"(kickOff Left)"})~");
  refused(R"({"do":"set","id":2,"path":"/sys/server/simulation","property":"step","value":1})");
  refused(R"({"do":"call","id":3,"path":"/sys/server/web","method":"refereeLink"})");
  spectator.say(R"({"do":"get","id":4,"path":"/sys/server/web"})");
  const std::string properties = spectator.textWith("\"id\":4");
  CHECK(count(properties, folder.file(token)) > 0);
  CHECK(count(properties, token) == count(properties, folder.file(token)));

  WebClient guesser(s.webPort);
  REQUIRE(guesser.watch() == 101);
  for (int i = 0; i < 4; ++i) {
    guesser.say(R"({"do":"login","token":")" + token.substr(0, 17 + i % 2) + "\"}");
    CHECK_THAT(guesser.textWith("\"referee\""), Contains("\"ok\":false"));
    s.readFrames();
  }
  guesser.say(R"({"do":"login","token":""})");
  guesser.waitForClose();
  s.host.waitForError("wrong referee's token");

  WebClient referee(s.webPort);
  REQUIRE(referee.watch() == 101);
  referee.say(R"({"do":"login","token":")" + token + "\"}");
  CHECK_THAT(referee.textWith("\"referee\""), Contains("\"ok\":true"));
  referee.say(R"~({"do":"command","id":5,"text":"(playMode corner_kick_left)"})~");
  CHECK_THAT(referee.textWith("\"id\":5"), Contains("\"ok\":true"));
  spectator.textWith("[\"play_mode\",");
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("A viewer that does not read uses bounded memory and is closed after a timeout") {
  WatchedArena s({"--set", "/sys/server/web.stallTimeout=1", "--set", "/sys/server/web.share=0.5"});
  const double before = s.memory();
  std::vector<std::unique_ptr<WebClient>> deaf;
  for (int i = 0; i < 8; ++i) {
    deaf.push_back(std::make_unique<WebClient>(s.webPort, 4096));
    REQUIRE(deaf.back()->watch() == 101);
    // The stream alone would take long to fill the socket buffers.
    for (int id = 0; id < 30; ++id) deaf.back()->say(R"({"do":"tree","path":"/","id":)" + std::to_string(id) + "}");
  }
  s.host.waitForError("you do not read what you are sent");
  CHECK(s.memory() < before + 64);
  // All must be disconnected before the test reads from any of them.
  while (nlohmann::json::parse(WebClient::status(s.webPort))["spectators"] > 1)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  for (auto& client : deaf) client->waitForClose();
  s.connectViewer();  // on a slow machine the viewer may have been closed, too
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("Clients that request files and never read them leave the host enough file descriptors") {
  constexpr rlim_t kFew = 700;
  TemporaryFolder folder;
  folder.write("long.log", std::string(4 << 20, 'x'));
  rlimit limit{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &limit) == 0);
  REQUIRE(limit.rlim_max >= 2 * kFew);
  limit.rlim_cur = kFew;
  REQUIRE(setrlimit(RLIMIT_NOFILE, &limit) == 0);
  WatchedArena s({"--set", "webLogs=" + folder.path().string()});  // started with the low limit
  limit.rlim_cur = 2 * kFew;
  REQUIRE(setrlimit(RLIMIT_NOFILE, &limit) == 0);
  const std::string request = "GET /logs/long.log HTTP/1.1\r\n" + local(s) + "\r\n";
  boost::asio::io_context io;
  std::vector<boost::asio::ip::tcp::socket> greedy;
  for (rlim_t i = 0; i < kFew; ++i) {
    auto& socket = greedy.emplace_back(io, boost::asio::ip::tcp::v4());
    socket.set_option(boost::asio::socket_base::receive_buffer_size(4096));
    socket.connect({boost::asio::ip::address_v4::loopback(), s.webPort});
    boost::system::error_code ignored;
    boost::asio::write(socket, boost::asio::buffer(request), ignored);
    s.readFrames();
  }
  CHECK(s.client().get("/status.json").status == 200);
  const auto open =
      std::distance(std::filesystem::directory_iterator("/proc/" + std::to_string(s.host.pid()) + "/fd"), {});
  CHECK(static_cast<rlim_t>(open) < kFew - 100);
  Witness newcomer(s.agentPort, "Late", 2);
  newcomer.mustSeeTimePass();
  s.mustContinue();
  s.mustEndWell();
}

TEST_CASE("Ten thousand connections displace no viewer, and a new client is still answered") {
  WatchedArena s;
  rlimit limit{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &limit) == 0);
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 11000);
  REQUIRE(setrlimit(RLIMIT_NOFILE, &limit) == 0);
  const std::size_t atOnce = std::min<std::size_t>(10000, limit.rlim_cur - 100);

  boost::asio::io_context io;
  std::vector<boost::asio::ip::tcp::socket> crowd;
  for (int i = 0; i < 10000; ++i) {
    if (crowd.size() == atOnce) crowd.clear();
    crowd.emplace_back(io).connect({boost::asio::ip::address_v4::loopback(), s.webPort});
    if (i % 1000 == 999)
      s.mustContinue();
    else if (i % 50 == 0)
      s.readFrames();
  }
  CHECK(s.client().get("/status.json").status == 200);
  WebClient viewer(s.webPort);
  REQUIRE(viewer.watch() == 101);
  viewer.binary();
  s.mustContinue();
  viewer.say(R"({"do":"get","id":1,"path":"/sys/server/web"})");
  CHECK_THAT(viewer.textWith("\"id\":1"), Contains("\"viewers\",\"value\":2"));
  s.mustEndWell();
}
