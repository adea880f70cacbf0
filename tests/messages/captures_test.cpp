#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <set>

#include "message.h"
#include "recording.h"
#include "test_support.h"

// Recorded sessions, replayed in lockstep. Messages to agents must have the recorded shape to the byte, apart from
// their numbers, and vision must agree with the recording within the noise. The conformance tool measures whether
// bodies follow the recording to the last digit.

using namespace spark::test;

namespace {

struct Session {
  const char* name;
  int looks;  ///< minimum number of messages with See that are compared by value, on any processor
  /// A trainer moves the ball. Its commands act up to one monitor period off, so the ball is not compared.
  bool ballIsMoved = false;
};
/// Sessions of one agent. Its pose is known while all of its other percepts agree with the recording, unless it was
/// beamed with noise.
const Session kSessions[] = {{"nao0-rest", 90}, {"ball-bounce-and-roll", 120, true}, {"nao0-all-joints", 20},
                             {"nao3-legs", 40}, {"nao0-squat-after-beam", 0},        {"team-walks-and-kicks", 300}};

/// Cycles in which the number may come a message earlier or later, because the simulation does not wait for agents yet.
constexpr int kJoining = 5;

/// One version of the original server.
struct Version {
  const char* compat;
  const char* folder;
  int decimals;
};
const Version kVersions[] = {{"M", "mainline", 2}, {"F", "spl", 3}};

std::filesystem::path captureFile(const Version& version, const std::string& session) {
  const auto folder = referenceFolder();
  if (folder.empty()) std::exit(77);
  for (const char* end : {".jsonl", ".jsonl.gz"})
    if (const auto file = folder / "captures" / version.folder / (session + end); std::filesystem::exists(file))
      return file;
  return {};
}

std::vector<std::string> settings(const Version& version, bool noise) {
  return {std::string("compat=") + version.compat, "Soccer.BeamNoiseXY=0", "Soccer.BeamNoiseAngle=0",
          std::string("Soccer.VisionNoise=") + (noise ? "true" : "false")};
}

/// A message with the parts that depend on contacts and vision separated.
struct Parts {
  std::vector<std::string> fixed;             ///< all but FRP, with See as "See"
  std::map<std::string, std::string> forces;  ///< FRP by name
  std::string see;
  std::string fault;
};

Parts take(const std::string& message, int decimals) {
  Parts out;
  std::string force;  // the percept of its joint must come next
  const std::vector<std::string> expressions = topLevel(message);
  if (expressions.empty()) out.fault = "something between expressions";
  for (const std::string& e : expressions) {
    const std::string what = label(e);
    if (!force.empty() && what != "HJ " + force.substr(0, 1) + "lj" + (force.ends_with("1") ? "7" : "6"))
      out.fault = "FRP " + force + " before " + what;
    force.clear();
    if (what.starts_with("FRP ")) {
      force = what.substr(4);
      out.forces[force] = e;
    } else if (what == "See") {
      out.see = e;
      out.fixed.push_back("See");
      if (const std::string fault = seeFault(e, decimals); !fault.empty()) out.fault = "See: " + fault;
    } else {
      out.fixed.push_back(e);
    }
  }
  return out;
}

/// While agents join, the players present may differ by a cycle.
std::string gsShape(std::string gs, bool joining) {
  if (joining) {
    gs = withoutAnnouncement(gs);
    gs = gs.substr(0, gs.find(" (ti "));
  }
  return shape(gs);
}

/// The first difference in shape, "" if there is none. GS may be that of one of the `near` cycles, because trainer
/// commands act up to a cycle off.
std::string difference(const Parts& ours, const Parts& recorded, const std::vector<Parts>& near, bool joining) {
  if (!ours.fault.empty()) return ours.fault;
  if (!recorded.fault.empty()) return "in the recording, " + recorded.fault;
  for (std::size_t i = 0; i < std::max(ours.fixed.size(), recorded.fixed.size()); ++i) {
    if (i >= ours.fixed.size()) return "nothing instead of " + recorded.fixed[i];
    if (i >= recorded.fixed.size()) return ours.fixed[i] + " too many";
    const std::string &a = ours.fixed[i], &b = recorded.fixed[i];
    if (shape(a) == shape(b)) continue;
    const bool gs = a.starts_with("(GS ") && b.starts_with("(GS ");
    if (gs && gsShape(a, joining) == gsShape(b, joining)) continue;
    const auto same = [&](const Parts& p) {
      return p.fixed.size() > i && gsShape(p.fixed[i], joining) == gsShape(a, joining);
    };
    if (gs && std::any_of(near.begin(), near.end(), same)) continue;
    return a + " instead of " + b;
  }
  for (const auto& [name, force] : ours.forces)
    if (const auto other = recorded.forces.find(name);
        other != recorded.forces.end() && shape(force) != shape(other->second))
      return force + " instead of " + other->second;
  return {};
}

/// True if all values without noise agree, so the robot has the recorded pose.
bool samePose(const Parts& ours, const Parts& recorded) {
  const auto agree = [](const std::string& a, const std::string& b) {
    const std::vector<double> x = decimals(a), y = decimals(b);
    if (x.size() != y.size()) return false;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::abs(x[i] - y[i]) > 0.021) return false;
    return true;
  };
  if (ours.fixed.size() != recorded.fixed.size() || ours.forces.size() != recorded.forces.size()) return false;
  for (std::size_t i = 0; i < ours.fixed.size(); ++i)
    if (!ours.fixed[i].starts_with("(time ") && !ours.fixed[i].starts_with("(GS ") &&
        !agree(ours.fixed[i], recorded.fixed[i]))
      return false;
  for (const auto& [name, force] : ours.forces)
    if (const auto other = recorded.forces.find(name); other == recorded.forces.end() || !agree(force, other->second))
      return false;
  return true;
}

// The noise model: standard deviations relative to the distance, in deg, in deg; and a calibration error of at most 5
// mm along each axis.
constexpr double kSigma[3] = {0.000965, 0.1480, 0.1225};
constexpr double kCalibration = 0.005 * 1.7321;
constexpr double kSigmas = 5.5;
constexpr double kCone = 60;  ///< deg

double radians(double deg) { return deg * 3.14159265358979 / 180; }
double degrees(double rad) { return rad * 180 / 3.14159265358979; }
/// The angle by which the calibration error may change the direction to a point [deg].
double turn(const Seen& s) { return degrees(std::asin(std::min(1.0, kCalibration / s.distance))); }

/// The maximum difference between two views of a point [m, deg, deg]; `rounding`: half of the last digit.
std::array<double, 3> tolerance(const Seen& s, double rounding) {
  return {kSigmas * kSigma[0] * s.distance + kCalibration + 2 * rounding,
          kSigmas * kSigma[1] + turn(s) / std::max(0.1, std::cos(radians(s.vertical))) + 2 * rounding,
          kSigmas * kSigma[2] + turn(s) + 2 * rounding};
}

bool close(const Seen& a, const Seen& b, double rounding) {
  const std::array<double, 3> limit = tolerance(a, rounding);
  return std::abs(a.distance - b.distance) <= limit[0] && std::abs(a.horizontal - b.horizontal) <= limit[1] &&
         std::abs(a.vertical - b.vertical) <= limit[2];
}
bool close(const Item& a, const Item& b, double rounding) {
  for (std::size_t i = 0; i < a.points.size(); ++i)
    if (a.name != b.name || !close(a.points[i], b.points[i], rounding)) return false;
  return true;
}

/// True at the edge of the view cone or of the window that clips lines, where noise decides whether an item is visible.
bool atEdge(const Item& item) {
  return std::any_of(item.points.begin(), item.points.end(), [](const Seen& s) {
    const double limit = kCone - kSigmas * kSigma[1] - turn(s);
    const double inWindow = degrees(std::atan2(std::tan(radians(s.vertical)), std::cos(radians(s.horizontal))));
    return std::abs(s.horizontal) > limit || std::abs(s.vertical) > limit || std::abs(inWindow) > limit;
  });
}

/// The standard deviation of the noise, from comparisons of noisy with noise-free values.
class Spread {
 public:
  void add(const Item& exact, const Item& noisy) {
    for (std::size_t i = 0; i < exact.points.size(); ++i) {
      const Seen &a = exact.points[i], &b = noisy.points[i];
      if (a.distance < 15) continue;  // closer, the calibration error and the last digit matter
      const double error[3] = {(b.distance - a.distance) / a.distance, b.horizontal - a.horizontal,
                               b.vertical - a.vertical};
      for (int k = 0; k < 3; ++k) squares_[k] += error[k] * error[k];
      ++count_;
    }
  }
  int count() const { return count_; }
  double sigma(int k) const { return std::sqrt(squares_[k] / count_); }

 private:
  double squares_[3] = {};
  int count_ = 0;
};

struct Looks {
  int compared = 0, items = 0, unmatched = 0;
  std::string fault;
  Spread spread;
};

void unmatchedItem(Looks& looks, const Item& item, const char* who) {
  ++looks.unmatched;
  if (!atEdge(item) && looks.fault.empty())
    looks.fault = fmt::format("{} sees {} at {} {} {}", who, item.name, item.points[0].distance,
                              item.points[0].horizontal, item.points[0].vertical);
}

/// Compares both lists in order. Items in only one of them must be at the edge of the view.
void compareLooks(const std::string& exact, const std::string& noisy, double rounding, Looks& looks,
                  bool withBall = true) {
  std::vector<Item> a = items(exact), b = items(noisy);
  if (!withBall)
    for (std::vector<Item>* all : {&a, &b}) std::erase_if(*all, [](const Item& item) { return item.name == "B"; });
  std::size_t next = 0;
  for (const Item& item : a) {
    ++looks.items;
    const auto at = std::find_if(b.begin() + static_cast<std::ptrdiff_t>(next), b.end(),
                                 [&](const Item& other) { return close(item, other, rounding); });
    if (at == b.end()) {
      unmatchedItem(looks, item, "only the host");
      continue;
    }
    const auto found = static_cast<std::size_t>(at - b.begin());
    for (; next < found; ++next) unmatchedItem(looks, b[next], "only the recorded player");
    looks.spread.add(item, *at);
    ++next;
  }
  for (; next < b.size(); ++next) unmatchedItem(looks, b[next], "only the recorded player");
  ++looks.compared;
}

/// The recorded messages of the adjacent cycles, in which the effect of a trainer command may appear.
std::vector<Parts> around(const Recording& r, const std::string& agent, int cycle, int decimals) {
  std::vector<Parts> out;
  if (r.commands.empty()) return out;
  for (int c : {cycle - 2, cycle - 1, cycle + 1, cycle + 2}) out.push_back(take(r.answer(agent, c), decimals));
  return out;
}

/// True if the recorded robot has been removed by now, because its messages repeat.
bool isGone(const Recording& r, const std::string& agent, int cycle) {
  return !r.answer(agent, cycle + 4).empty() && r.answer(agent, cycle + 3) == r.answer(agent, cycle + 4);
}

std::string complaints(const std::string& errors) {
  std::istringstream lines(errors);
  std::string out;
  for (std::string line; std::getline(lines, line);)
    if (line.find("no effector registered for predicate syn") == std::string::npos) out += line + "\n";
  return out;
}

/// Appends the assigned numbers.
void note(std::vector<std::string>& announced, const Parts& parts) {
  for (const std::string& e : parts.fixed)
    if (e.starts_with("(GS (unum ")) announced.push_back(e.substr(0, e.find("(sl ")));
}

}  // namespace

TEST_CASE("Messages of another shape, looks at other places and lines of the log are found") {
  const auto of = [](const std::string& percepts) { return take("(time (now 1.00))" + percepts, 2); };
  const Parts hinge = of("(HJ (n hj1) (ax 0.00))");
  CHECK(difference(hinge, of("(HJ (n hj1) (ax -5.00))"), {}, false) == "");
  for (const char* const other : {"(HJ (n hj1) (ax 0.000))", "(HJ (n hj2) (ax 0.00))", ""}) {
    CHECK(difference(hinge, of(other), {}, false) != "");
    CHECK(difference(of(other), hinge, {}, false) != "");
  }
  const auto fault = [](const std::string& other) {
    Looks looks;
    compareLooks("(See (F1L (pol 5.00 0.00 0.00)))", "(See (F1L (pol " + other + ")))", 0.005, looks);
    return looks.fault;
  };
  CHECK(fault("5.00 0.10 0.00") == "");
  for (const char* const other : {"9.00 0.00 0.00", "5.00 20.00 0.00", "5.00 0.00 -20.00"}) CHECK(fault(other) != "");
  CHECK(complaints("no effector registered for predicate syn.\n") == "");
  CHECK(complaints("no effector registered for predicate fly.\n") != "");
}

TEST_CASE("A recorded session of a player gives messages of the recorded shape, and vision within the noise") {
  Spread all;
  for (const Version& version : kVersions) {
    for (const Session& session : kSessions) {
      const auto file = captureFile(version, session.name);
      if (file.empty()) continue;
      CAPTURE(version.compat, session.name);
      const Recording recording = readRecording(file);
      Looks looks;
      looks.spread = all;
      bool known = true;
      int forces = 0, forcesMissing = 0, told = 0;
      std::vector<std::string> ours, theirs;
      const double rounding = 0.5 * std::pow(10, -version.decimals);
      const std::string errors = replay(
          recording, settings(version, false), [&](int cycle, const std::string& agent, const std::string& answer) {
            CAPTURE(cycle);
            const std::string& recorded = recording.answer(agent, cycle);
            const Parts a = take(answer, version.decimals), b = take(recorded, version.decimals);
            REQUIRE(difference(a, b, around(recording, agent, cycle, version.decimals), cycle < kJoining) == "");
            ++told;
            note(ours, a), note(theirs, b);
            forces += static_cast<int>(b.forces.size());
            for (const auto& [name, force] : b.forces) forcesMissing += !a.forces.contains(name);
            known = known && samePose(a, b) && (session.looks > 0 || cycle < 10);
            if (known && !a.see.empty()) compareLooks(a.see, b.see, rounding, looks, !session.ballIsMoved);
          });
      CHECK(told == recording.cycles);
      CHECK(ours == theirs);
      CHECK(complaints(errors) == "");
      CHECK(looks.fault == "");
      CHECK(looks.compared >= session.looks);
      CHECK(looks.unmatched * 15 <= looks.items);
      all = looks.spread;
      WARN(version.folder << "/" << session.name << ": " << told << " messages, " << looks.compared << " looks with "
                          << looks.items << " items compared, " << looks.unmatched
                          << " at the edge of the view seen by one only, " << forcesMissing << " of " << forces
                          << " contact forces not felt");
    }
  }
  // The recorded noise agrees with the model.
  REQUIRE(all.count() > 5000);
  for (int k = 0; k < 3; ++k) CHECK(all.sigma(k) == Approx(kSigma[k]).epsilon(0.05));
}

TEST_CASE("The host's noise has the recorded distribution") {
  const Recording recording = readRecording(captureFile(kVersions[1], "nao0-rest"));
  std::map<int, std::string> exact;
  replay(recording, settings(kVersions[1], false),
         [&](int cycle, const std::string&, const std::string& answer) { exact[cycle] = take(answer, 3).see; });
  Looks looks;
  double maxError = 0;
  replay(recording, settings(kVersions[1], true), [&](int cycle, const std::string&, const std::string& answer) {
    const std::string see = take(answer, 3).see;
    REQUIRE(see.empty() == exact[cycle].empty());
    if (see.empty()) return;
    compareLooks(exact[cycle], see, 0.0005, looks);
    for (const Item& item : items(see))
      if (item.name.ends_with("lowerarm")) maxError = std::max(maxError, std::abs(item.points[0].distance - 0.185));
  });
  CHECK(looks.fault == "");
  CHECK(looks.unmatched * 50 <= looks.items);
  for (int k = 0; k < 3; ++k) CHECK(looks.spread.sigma(k) == Approx(kSigma[k]).epsilon(0.1));
  CHECK(maxError > 0.001);  // the calibration error matters most close to the head
  CHECK(maxError < kCalibration + 0.002);
}

TEST_CASE("A recorded session of four players gives messages of the recorded shape") {
  for (const Version& version : kVersions) {
    CAPTURE(version.compat);
    const Recording recording = readRecording(captureFile(version, "four-agents"));
    std::map<std::string, std::vector<std::string>> ours, theirs;
    std::set<std::string> gone;
    int heard = 0;
    replay(recording, settings(version, true), [&](int cycle, const std::string& agent, const std::string& answer) {
      CAPTURE(cycle, agent);
      if (answer.empty()) {  // the recorded server repeats its last message to a killed robot, this host closes the
                             // connection
        REQUIRE(isGone(recording, agent, cycle));
        gone.insert(agent);
        return;
      }
      if (isGone(recording, agent, cycle)) return;
      const Parts a = take(answer, version.decimals), b = take(recording.answer(agent, cycle), version.decimals);
      REQUIRE(difference(a, b, around(recording, agent, cycle, version.decimals), cycle < kJoining) == "");
      note(ours[agent], a), note(theirs[agent], b);
      for (const std::string& e : a.fixed) heard += e.starts_with("(hear ");
    });
    CHECK(ours == theirs);
    CHECK(gone == std::set<std::string>{"agent3"});
    CHECK(heard > 100);
  }
}
