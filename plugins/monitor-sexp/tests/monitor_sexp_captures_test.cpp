#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "monitor_message.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("every recorded monitor message is identical after decoding and encoding") {
  const auto folder = referenceFolder();
  if (folder.empty()) std::exit(77);
  TestHost host;
  host.kernel.plugins().use("monitor-sexp");
  auto& encoder = host.kernel.create<IMonitorEncoder>("SexpMonitor", "/usr/encoder");
  for (const char* name : {"nao0-rest", "ball-bounce-and-roll", "four-agents"}) {
    INFO(name);
    std::ifstream file(folder / "captures" / "mainline" / (std::string(name) + ".jsonl"));
    RecordedFrame recorded;
    int messages = 0;
    for (std::string line; std::getline(file, line);) {
      const auto row = nlohmann::json::parse(line);
      if (row["dir"] != "server>monitor") continue;
      const std::string message = row["msg"];
      recorded.read(message);
      std::string written;
      encoder.encode(recorded.update, written);
      if (written != message)
        FAIL("in message " << messages << " of " << name << "\nexpected " << message << "\nfound    " << written);
      ++messages;
    }
    CHECK(messages > 50);
  }
}
