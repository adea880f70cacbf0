/// \file
/// Replays recorded lockstep sessions of the original server against a host of this build and prints the deviation of
/// the noise-free sensors from the recorded ones.
///
///     spark-conformance                         every session, as a Markdown table
///     spark-conformance mainline/nao0-rest ...  these
///
/// Sessions are files below SPARK_REFERENCE_DIR/captures. Exit code 0: all printed digits equal the recorded ones; 1:
/// there are differences; 77: no reference data. A session whose beam was recorded with noise is replayed with the beam
/// that its monitor frames show.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>

#include "ball_path.h"
#include "messages/recording.h"
#include "spark/predicates.h"
#include "test_support.h"

namespace spark::test {
namespace {

const std::vector<std::string> kSessions{"mainline/nao0-rest",
                                         "mainline/nao0-all-joints",
                                         "mainline/nao0-squat-after-beam",
                                         "mainline/nao3-legs",
                                         "mainline/team-walks-and-kicks",
                                         "mainline/team-walks-and-dribbles",
                                         "mainline/team-scores-and-beams-again",
                                         "mainline/ball-bounce-and-roll",
                                         "spl/nao0-rest",
                                         "spl/nao0-all-joints",
                                         "spl/nao0-squat-after-beam",
                                         "spl/nao3-legs",
                                         "spl/ball-bounce-and-roll"};

/// `(beam -2 0.5 30)` with the noise of the recording: x [m], y [m], angle [deg], from the torso's matrix in the
/// following frames.
const std::map<std::string, std::string> kNoisyBeams{
    {"mainline/nao0-squat-after-beam", "(beam -2.0413 0.479276 20.387088)"},
    {"spl/nao0-squat-after-beam", "(beam -1.95753 0.516926 37.928452)"}};

/// The numbers of each channel in a message: "HJ hj1" -> {1.72}, "FRP rf" -> {c, f}.
using Readings = std::map<std::string, std::vector<double>>;

Readings readingsOf(const std::string& message) {
  Readings out;
  Predicates p;
  readSexp(message, p);
  for (const Element e : p) {
    const std::string head(e.head());
    if (head != "HJ" && head != "GYR" && head != "ACC" && head != "FRP") continue;
    std::vector<double>& numbers = out[head + " " + std::string(e.named("n").at(1).text())];
    for (const Element part : e) {
      if (!part.isList() || part.head() == "n") continue;
      for (std::size_t i = 1; const Element number = part.at(i); ++i) numbers.push_back(number.number());
    }
  }
  return out;
}

struct Deviation {
  std::map<std::string, double> maxima{{"HJ", 0}, {"GYR", 0}, {"ACC", 0}, {"FRP", 0}};
  std::size_t compared = 0, differ = 0;  ///< numbers compared; how many of them differ from the recorded ones
  int shape = 0;                         ///< messages whose sensors differ from the recorded ones
  std::string first;                     ///< the first difference

  void compare(int cycle, const std::string& recorded, const std::string& ours) {
    const Readings want = readingsOf(recorded), got = readingsOf(ours);
    bool alike = want.size() == got.size();
    for (const auto& [channel, numbers] : want) {
      const auto found = got.find(channel);
      if (found == got.end() || found->second.size() != numbers.size()) {
        alike = false;
        continue;
      }
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double off = std::abs(numbers[i] - found->second[i]);
        ++compared;
        if (!(off > 0)) continue;
        ++differ;
        double& maximum = maxima[channel.substr(0, channel.find(' '))];
        maximum = std::max(maximum, off);
        note(cycle, fmt::format("{} is {}, recorded {}", channel, found->second[i], numbers[i]));
      }
    }
    if (alike) return;
    ++shape;
    note(cycle, "other sensors than recorded");
  }
  bool none() const { return compared > 0 && differ == 0 && shape == 0; }

 private:
  void note(int cycle, const std::string& what) {
    if (first.empty()) first = fmt::format("cycle {}: {}", cycle, what);
  }
};

struct Outcome {
  Deviation sensors;
  BallPath recordedBall, ball;
  int cycles = 0;
};

Outcome replaySession(const std::string& name, const Recording& recording) {
  // A frame in every cycle: the recording has every second one, and which half depends on the cycle in which the agent
  // came.
  std::vector<std::string> settings{"Soccer.BeamNoiseXY=0", "Soccer.BeamNoiseAngle=0",
                                    "/sys/server/monitor.interval=1"};
  if (name.starts_with("spl/")) settings.push_back("/sys/server/gamecontrol/parser.decimals=3");
  LockstepHost host(settings);
  Client monitor(host.monitorPort), agent(host.agentPort);
  Outcome out;
  out.cycles = recording.cycles;
  for (const std::string& frame : recording.frames) out.recordedBall.feed(frame);
  const auto send = [&](int cycle) {
    if (const auto at = recording.commands.find(cycle); at != recording.commands.end())
      for (const std::string& command : at->second) monitor.send(command);
    if (const auto at = recording.sent.find(cycle); at != recording.sent.end())
      for (auto said : at->second) {
        const auto noisy = kNoisyBeams.find(name);
        if (noisy != kNoisyBeams.end() && said.message.starts_with("(beam ")) said.message = noisy->second + "(syn)";
        agent.send(said.message);
      }
  };
  send(0);
  for (int cycle = 0; cycle < recording.cycles; ++cycle) {
    const std::string answer = agent.receive();
    out.sensors.compare(cycle, recording.answer(recording.agents.front(), cycle), answer);
    while (monitor.pending()) out.ball.feed(monitor.receive());
    if (!recording.ball.empty()) monitor.send("(reqfullstate)");  // diffs omit small movements
    send(cycle + 1);
  }
  host.end();
  return out;
}

/// The report about the ball, and whether its path equals the recorded one.
std::pair<std::string, bool> judgeBall(const std::string& name, const Recording& recording, const Outcome& o) {
  const bool thrown = name.ends_with("ball-bounce-and-roll");
  if (!thrown && recording.ball.empty()) return {"-", true};
  const std::vector<std::string>& recorded = thrown ? o.recordedBall.positions() : recording.ball;
  const bool same = samePath(recorded, o.ball.positions());
  return {fmt::format("{} of {} places, the last {}", same ? "all" : "NOT all", recorded.size(), recorded.back()),
          same};
}

bool report(const std::string& name, const std::filesystem::path& folder) {
  std::filesystem::path file = folder / (name + ".jsonl");
  if (!std::filesystem::exists(file)) file += ".gz";
  const Recording recording = readRecording(file);
  const Outcome o = replaySession(name, recording);
  const auto& maximum = o.sensors.maxima;
  const auto [ball, ballSame] = judgeBall(name, recording, o);
  std::cout << fmt::format("| {}{} | {} | {} | {:g} | {:g} | {:g} | {:g} | {} | {} | {} |\n", name,
                           kNoisyBeams.contains(name) ? " \\*" : "", o.cycles, o.sensors.compared, maximum.at("HJ"),
                           maximum.at("GYR"), maximum.at("ACC"), maximum.at("FRP"), o.sensors.differ, o.sensors.shape,
                           ball)
            << std::flush;
  if (!o.sensors.first.empty()) std::cerr << name << ": first at " << o.sensors.first << "\n";
  return o.sensors.none() && ballSame;
}

int run(std::vector<std::string> names) {
  const std::filesystem::path reference = referenceFolder();
  if (reference.empty()) {
    std::cerr << "Set SPARK_REFERENCE_DIR to the folder that holds captures/.\n";
    return 77;
  }
  if (names.empty()) names = kSessions;
  std::cout << "| session | cycles | numbers | HJ [deg] | GYR [deg/s] | ACC [m/s^2] | FRP [m, N] | differ | other "
               "sensors | ball |\n"
               "|---|---|---|---|---|---|---|---|---|---|\n";
  bool exact = true;
  for (const std::string& name : names) exact = report(name, reference / "captures") && exact;
  return exact ? 0 : 1;
}

}  // namespace
}  // namespace spark::test

int main(int argc, char** argv) {
  try {
    return spark::test::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::cerr << "spark-conformance: " << e.what() << "\n";
    return 1;
  }
}
