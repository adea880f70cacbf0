#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "../site.h"
#include "../stream/messages.h"
#include "../viewer_message.h"
#include "api/credentials.h"
#include "spark/error.h"
#include "temporary_folder.h"

// How input bytes are parsed and how messages are written.

using namespace spark;
using namespace spark::web;
using What = ViewerMessage::What;
using Catch::Contains;

TEST_CASE("Viewers' messages are parsed, or refused with the expected format") {
  CHECK(readViewerMessage(R"({"do":"view","rate":1000})").rate == kMaxRate);
  CHECK(readViewerMessage(R"({"do":"view","rate":-5})").rate == kMinRate);
  CHECK_FALSE(readViewerMessage(R"({"do":"view","rate":10})").fine.has_value());
  CHECK(readViewerMessage(R"({"do":"view","detail":"coarse"})").fine == false);
  CHECK(readViewerMessage(R"({"do":"drawings","on":false})").on == false);
  CHECK(readViewerMessage(R"({"do":"login","token":"x"})").text == "x");
  CHECK(readViewerMessage(R"({"do":"unwatch","id":8})").what == What::unwatch);
  const ViewerMessage watch = readViewerMessage(R"({"do":"watch","id":-3,"path":"/x","property":"p"})");
  CHECK((watch.what == What::request && watch.id == -3));
  CHECK(readViewerMessage(R"({"do":"history","id":1})").what == What::history);
  CHECK_FALSE(readViewerMessage(R"({"do":"history","id":1})").at.has_value());
  CHECK(readViewerMessage(R"({"do":"history","id":1,"at":-2.5e300})").at == -2.5e300);
  CHECK(readViewerMessage(R"({"do":"history","id":1,"scene":4294967295})").scene == 4294967295u);
  for (const char* bad : {"",
                          "x",
                          "7",
                          "[]",
                          "{}",
                          R"({"do":1})",
                          R"({"do":"view","rate":"x"})",
                          R"({"do":"view","detail":"rough"})",
                          R"({"do":"login"})",
                          R"({"do":"get"})",
                          R"({"do":"get","id":1.5})",
                          R"({"do":"drawings"})",
                          R"({"do":"command","id":1})",
                          R"({"do":"history"})",
                          R"({"do":"history","id":1,"at":"x"})",
                          R"({"do":"history","id":1,"at":1e999})",
                          R"({"do":"history","id":1,"at":null})",
                          R"({"do":"history","id":1,"scene":-1})",
                          R"({"do":"history","id":1,"scene":1.5})",
                          R"({"do":"history","id":1,"scene":4294967296})",
                          "{\"do\":\"get\",\"id\":1,\"x\":\"\xff\"}"}) {
    INFO(bad);
    CHECK_THROWS_AS(readViewerMessage(bad), Error);
  }
  const auto nested = [](int depth) {
    return R"({"do":"get","id":1,"x":)" + std::string(depth, '[') + std::string(depth, ']') + "}";
  };
  CHECK_NOTHROW(readViewerMessage(nested(30)));
  CHECK_THROWS_WITH(readViewerMessage(nested(40)), Contains("32 deep"));
}

TEST_CASE("A token has 128 random bits and equals only itself") {
  const std::string token = makeToken();
  CHECK(token.size() == 32);
  CHECK(
      std::all_of(token.begin(), token.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }));
  CHECK(makeToken() != token);
  CHECK(isToken(token, token));
  CHECK_FALSE(isToken(token, token + token));
  CHECK_FALSE(isToken(token, token.substr(1)));
  CHECK_FALSE(isToken(token, ""));
  CHECK_FALSE(isToken("", ""));
}

TEST_CASE("Text that is not UTF-8 and numbers that are not finite still give valid JSON") {
  std::string out;
  JsonWriter(out, kWebJson)
      .beginArray()
      .value("plain")
      .value("quote\" back\\ \n \xff \xe2\x82\xac </script>")
      .value(std::nan(""))
      .value(HUGE_VAL)
      .value(0.1)
      .endArray();
  CHECK(std::all_of(out.begin(), out.end(), [](unsigned char c) { return c < 128; }));
  const auto read = nlohmann::json::parse(out);
  CHECK(read[0] == "plain");
  CHECK(read[1] == "quote\" back\\ \n \xef\xbf\xbd \xe2\x82\xac </script>");
  CHECK(read[2] == 0);
  CHECK(read[4] == 0.1);
  Predicates p;
  readSexp("(team_left nan)(time 1.5)(foul 1 left (x 2e3))(name inf -)", p);
  std::string elements;
  JsonWriter json(elements, kWebJson);
  json.beginArray();
  for (const Element e : p) writeElement(json, e);
  json.endArray();
  CHECK(elements == R"([["team_left","nan"],["time",1.5],["foul",1,"left",["x",2000]],["name","inf","-"]])");
}

TEST_CASE("Paths below a folder consist of plain names") {
  using Names = std::vector<std::string>;
  CHECK(plainComponents("a.log") == Names{"a.log"});
  CHECK(plainComponents("assets/index-1.js") == Names{"assets", "index-1.js"});
  CHECK(plainComponents("Red%20vs%20Blue.log") == Names{"Red vs Blue.log"});
  CHECK(plainComponents("%41%e2%82%ac") == Names{"A\xe2\x82\xac"});
  for (const char* bad : {"",    "/",     "a/",   "/a",    "a//b",  ".",    "..", "../a", "a/..", ".a",       "%2e%2e",
                          "%2e", "a%2fb", "a\\b", "a%5cb", "a%00b", "a%0a", "%",  "%4",   "%4g",  "a/b/c/d/e"}) {
    INFO(bad);
    CHECK(plainComponents(bad).empty());
  }
}

TEST_CASE("Existing files are served with their type, and without a viewer there is a plain page") {
  spark::test::TemporaryFolder folder;
  folder.write("index.html", "<p>viewer");
  folder.write("secret", "root:");
  std::filesystem::create_directory(folder.path() / "assets");
  folder.write("assets/index-1.js", "1");
  std::filesystem::create_directory(folder.path() / "logs");
  folder.write("logs/game.log", "((time 0))");
  const auto request = [](std::string_view target) {
    return HttpRequest{"GET", target, "localhost", "", false, false};
  };
  const Site site({folder.path(), "", folder.path() / "logs", {}});
  CHECK(site.answer(request("/")).file == folder.path() / "index.html");
  CHECK(site.answer(request("/?file=/logs/game.log")).type == "text/html; charset=utf-8");
  CHECK(site.answer(request("/assets/index-1.js")).type == "text/javascript; charset=utf-8");
  CHECK(site.answer(request("/assets/index-1.js")).immutable);
  CHECK_FALSE(site.answer(request("/")).immutable);
  CHECK(site.answer(request("/logs/game.log")).file == folder.path() / "logs/game.log");
  for (const char* name : {"logs/trap.html", "logs/trap.js", "logs/trap.svg"}) {
    folder.write(name, "<script>");
    CHECK(site.answer(request("/" + std::string(name))).type == "text/plain; charset=utf-8");
  }
  folder.write("logs/game.log.gz", "1");
  CHECK(site.answer(request("/logs/game.log.gz")).type == "application/gzip");
  for (const char* missing : {"/logs/", "/logs", "/logs/..", "/logs/../secret", "/none", "/assets", "/assets/"}) {
    INFO(missing);
    CHECK(site.answer(request(missing)).status == 404);
  }
  CHECK(site.answer(request("/status.json")).isStatus);
  const Site plain({"", "Node.js <18>", "", {}});
  CHECK_THAT(plain.answer(request("/")).text, Contains("missing is Node.js &lt;18>") && Contains("plain.js"));
  CHECK(plain.answer(request("/logs/game.log")).status == 404);
  CHECK(plain.answer(request("/assets/index-1.js")).status == 404);
}

TEST_CASE("Host names that cannot be rebound are accepted, and only pages of this server may open a stream") {
  const Site site({"", "", "", {"Match.Example"}});
  for (const char* ours : {"127.0.0.1", "127.0.0.1:80", "[::1]:80", "[fe80::1]", "10.1.2.3:5", "localhost",
                           "LocalHost:9", "a.localhost", "match.example:443"})
    CHECK(site.acceptsHost(ours));
  for (const char* strange : {"", ":80", "evil.example", "127.0.0.1.evil.example", "127.0.0.1x", "notlocalhost", "[::1",
                              "[]", "xmatch.example", "localhost."}) {
    INFO(strange);
    CHECK_FALSE(site.acceptsHost(strange));
  }
  CHECK(Site({"", "", "", {"*"}}).acceptsHost("any.example"));
  CHECK(isSameOrigin("http://localhost:80", "localhost:80"));
  CHECK(isSameOrigin("https://MATCH.example", "match.example"));
  for (const char* origin : {"http://localhost", "http://localhost:81", "null", "ftp://localhost:80", "localhost:80",
                             "http://localhost:80/", "http://x.localhost:80"})
    CHECK_FALSE(isSameOrigin(origin, "localhost:80"));
}
