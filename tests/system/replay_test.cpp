// sparkreplay --play: recordings are shown to monitors.
#include <fmt/format.h>

#include <cmath>

#include "recorded.h"

using namespace spark::test;
using Catch::Contains;

namespace {
/// sparkreplay, which shows a file to monitors.
struct Replay {
  std::unique_ptr<Process> process;
  unsigned short port = 0;
  explicit Replay(std::vector<std::string> command) : process(std::make_unique<Process>(std::move(command))) {
    port = static_cast<unsigned short>(Json::parse(process->line())["monitorPort"].get<int>());
  }
  /// Seeks, and returns the words and numbers that a new monitor receives. `seconds` must differ from the last call's.
  std::vector<std::string> at(double seconds) {
    const Finished set = runToEnd(
        joined(sparkctl(process->pid()), {"set", "/sys/server/monitor/player.time", fmt::format("{}", seconds)}));
    REQUIRE(set.code == 0);
    // A frame may be under way that was made before.
    for (;;) {
      std::vector<std::string> words = split(Client(port).receive());
      const auto time = std::find(words.begin(), words.end(), "time");
      REQUIRE(time + 1 < words.end());
      if (std::exchange(shown, time[1]) != time[1]) return words;
    }
  }
  static std::vector<std::string> split(const std::string& message) {
    std::vector<std::string> out(1);
    for (const char c : message) {
      const bool bracket = c == '(' || c == ')';
      if ((bracket || c == ' ') && !out.back().empty()) out.emplace_back();
      if (bracket) out.back() = c, out.emplace_back();
      if (!bracket && c != ' ') out.back() += c;
    }
    return out;
  }
  std::string shown = "0";  ///< time in the game that it showed last
};

/// Describes the first difference, or "". Numbers may differ by a few quanta of the recording.
std::string firstDifference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] == b[i]) continue;
    char *endA = nullptr, *endB = nullptr;
    const double x = std::strtod(a[i].c_str(), &endA), y = std::strtod(b[i].c_str(), &endB);
    if (*endA != 0 || *endB != 0 || std::abs(x - y) > 0.006)
      return fmt::format("{} {} {} against {} at {}", a[i - (i > 0)], a[i], i + 1 < a.size() ? a[i + 1] : "", b[i], i);
  }
  return a.size() == b.size() ? "" : fmt::format("{} words against {}", a.size(), b.size());
}
}  // namespace

TEST_CASE("A recording plays to monitors as the monitor log of the same match does, at any time") {
  Recorded match("soccer.lua", "humanoid-team", 1,
                 joined(kLockstep, {"--duration", "8", "--set", "Soccer.AutomaticKickOff=true", "--set",
                                    "Soccer.WaitBeforeKickOff=1"}));
  match.end();
  const std::string log = match.folder.path() / "match.log";
  REQUIRE(runToEnd({program("sparkreplay"), match.file, "--export", log}).code == 0);
  Replay recording({program("sparkreplay"), match.file, "--play", "--speed", "0", "--monitor-port", "0", "--web-port",
                    "0", "--log-level", "error"});
  Replay text({program("sparkhost"), "--config", "logplayer.lua", "--set", "file=" + log, "--set", "speed=0",
               "--monitor-port", "0", "--web-port", "0", "--log-level", "error"});
  // The log has a record each 0.2 s from 0.04 s on, the recording a frame each 0.08 s.
  const double first = 0.04;
  for (const double t : {4.24, 0.64, 6.24}) {
    INFO("at " << t << " s");
    CHECK(firstDifference(recording.at(t), text.at(t - first)) == "");
  }
  CHECK(firstDifference(recording.at(4.24), text.at(0.64 - first)) != "");
}

TEST_CASE("A recording plays forwards and backwards, and begins where it is told") {
  Recorded match("soccer-sphere.lua", "sphere-team", 1,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "6"}));
  match.end();
  const auto timesFrom = [&](const std::vector<std::string>& arguments) {
    Replay player(joined({program("sparkreplay"), match.file, "--play", "--monitor-port", "0", "--web-port", "0",
                          "--log-level", "error"},
                         arguments));
    std::vector<double> out;
    Client monitor(player.port);
    while (out.size() < 4) {
      monitor.receive();
      const Finished time =
          runToEnd(joined(sparkctl(player.process->pid()), {"get", "/sys/server/monitor/player.time"}));
      const double t = std::stod(time.out.substr(time.out.find("= ") + 2));
      if (out.empty() || t != out.back()) out.push_back(t);
    }
    return out;
  };
  // Slow, so that a busy machine does not miss all of it.
  const auto forwards = timesFrom({"--from", "2", "--speed", "0.1"}), backwards = timesFrom({"--speed", "-0.1"});
  CHECK(std::is_sorted(forwards.begin(), forwards.end()));
  CHECK(forwards.front() >= 1.9);
  CHECK(std::is_sorted(backwards.rbegin(), backwards.rend()));
  CHECK(backwards.front() > 3);
}

TEST_CASE("A recording without frames is not played") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "boxes.mcap";
  REQUIRE(runToEnd({program("sparkhost"), "--config", "boxes.lua", "--rate", "max", "--duration", "1", "--set",
                    "web=false", "--log-level", "error", "--record", file})
              .code == 0);
  const Finished played = runToEnd({program("sparkreplay"), file, "--play", "--monitor-port", "0", "--web-port", "0"});
  CHECK(played.code == 2);
  CHECK_THAT(played.errors, Contains("has no frames to show"));
}
