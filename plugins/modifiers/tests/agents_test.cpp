#include <catch2/catch.hpp>

#include "lab.h"
#include "spark/error.h"
#include "spark/script_server.h"

// Modifiers below the perceptors and effectors of agents: scene files and Lua, cycles, threads, state, faults.

using namespace spark;
using namespace spark::test;

namespace {
/// A modifier that fails in one cycle.
class Broken : public Modifier {
  SPARK_CLASS(Broken, Modifier)
 public:
  static void describe(Description<Broken>& d) { d.doc("Throws."); }
  void apply(Signal& signal, const Event&) override {
    if (!signal.empty()) throw Error("no more");
  }
};

/// The example of docs/plugin-guide.md.
class DeadZone : public NumberModifier {
  SPARK_CLASS(DeadZone, NumberModifier)
 public:
  static void describe(Description<DeadZone>& d) {
    d.doc("Small numbers become 0, as a motor with friction does not follow them.");
    d.property("width", &DeadZone::width_)
        .unit("of the number")
        .min(0)
        .doc("Numbers between -width and width are small.");
  }

 protected:
  double change(double value, std::size_t, const Event&) override { return std::abs(value) < width_ ? 0 : value; }

 private:
  double width_ = 0;
};

/// A robot with an effector, and a sensor, as behaviors think about percepts only.
std::string robot(const std::string& effector) { return "(nd CycleSensor (setName s))" + effector; }

const char* const kNoisy = R"(
    (nd CycleSensor (setName one)
        (nd Bias (setSigma 1)) (nd WhiteNoise (setSigma 0.5)) (nd RandomWalk (setSigma 1)) (nd Dropout (setProbability 0.2)))
    (nd CycleSensor (setName two) (setInterval 3)
        (nd WhiteNoise (setSigma 0.5)) (nd Delay (setCycles 4)) (nd Jitter (setCycles 5)))
    (nd Recorder (setName motor)
        (nd Backlash (setWidth 0.5)) (nd WhiteNoise (setSigma 0.1)) (nd Delay (setSeconds 0.1))))";

/// What two agents of kNoisy sense, cycle by cycle.
std::vector<std::string> senses(Lab& lab, int cycles) {
  std::vector<std::string> out;
  for (int i = 0; i < cycles; ++i) {
    for (Speaker* s : lab.speakers) s->next = fmt::format("(motor {})", i % 7);
    lab.run(1);
    for (int agent = 1; agent <= static_cast<int>(lab.speakers.size()); ++agent) out.push_back(lab.sensed(agent, 17));
  }
  return out;
}
}  // namespace

TEST_CASE("Noise on the position of a GPS, from a scene file") {
  Lab lab(R"(
    (nd Transform (setLocalPos 1 2 3)
        (nd GPS (setName gps)
            (nd WhiteNoise (setName noise) (setField tf) (setIndices 3 7 11) (setSigma 0.01)))))");
  Leaf& noise = *lab.control->agents()[0]->children().back()->find("gps/noise");
  CHECK(getProperty(noise, "sigma").toNumber() == Approx(0.01));
  const double truth[16] = {1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
  std::string before;
  for (int cycle = 0; cycle < 20; ++cycle) {
    lab.run(1);
    const Element tf = (*lab.control->percepts(*lab.control->agents()[0])->begin()).named("tf");
    for (std::size_t i = 0; i < 16; ++i) {
      const double error = tf.at(i + 1).number() - truth[i];
      const bool noisy = i == 3 || i == 7 || i == 11;
      CHECK(noisy == (error != 0));
      CHECK(std::abs(error) < 0.06);
    }
    CHECK(lab.sensed(1, 17) != before);
    before = lab.sensed(1, 17);
  }
}

TEST_CASE("A chain from Lua, also in a running simulation; without it the percept is exact again") {
  Lab lab("(nd CycleSensor (setName s))");
  CHECK(lab.sense() == "(C (n s) (v 4.00 4.00))");
  scripts(lab.kernel)
      .run(R"lua(
      local s = get("/usr/scene/AgentAspect1/s")
      s:new("Gain", "scale").gain = 2
      local bias = s:new("Bias", "bias")
      bias.field, bias.indices, bias.mean = "v", {1}, 0.5)lua",
           "chain");
  CHECK(lab.sense() == "(C (n s) (v 10.00 10.50))");
  scripts(lab.kernel).run(R"lua(delete("/usr/scene/AgentAspect1/s/scale"))lua", "chain");
  CHECK(lab.sense() == "(C (n s) (v 6.00 6.50))");
  scripts(lab.kernel).run(R"lua(delete("/usr/scene/AgentAspect1/s/bias"))lua", "chain");
  CHECK(lab.sense() == "(C (n s) (v 7.00 7.00))");
}

TEST_CASE("A modifier that is removed after the act phase is not applied any more") {
  Lab lab("(nd CycleSensor (setName s) (nd Gain (setName g) (setGain 2)))");
  CHECK(lab.sense() == "(C (n s) (v 8.00 8.00))");
  scripts(lab.kernel)
      .run(R"lua(local hook; hook = on("rule", function() hook:remove() delete("/usr/scene/AgentAspect1/s/g") end))lua",
           "rule");
  CHECK(lab.sense() == "(C (n s) (v 5.00 5.00))");
}

TEST_CASE("A percept is exactly so many cycles late, whatever the interval of its perceptor") {
  Lab lab(R"((nd CycleSensor (setName s) (nd Delay (setCycles 2)))
             (nd CycleSensor (setName t) (setInterval 3) (nd Delay (setCycles 1))))");
  const auto late = [](int cycle) { return fmt::format("(C (n s) (v {0}.00 {0}.00))", cycle); };
  const auto rare = [](int cycle) { return fmt::format("(C (n t) (v {0}.00 {0}.00))", cycle); };
  for (int cycle = 4; cycle < 20; ++cycle) {
    std::string expected = cycle >= 5 ? late(cycle - 2) : "";
    // An agent's cycles are counted from the cycle in which it joins.
    if ((cycle - 1) % 3 == 0) expected += rare(cycle - 1);
    CHECK(lab.sense() == expected);
  }
}

TEST_CASE("With agentStep the cycles of a delay are turns of the agent") {
  Lab lab("(nd CycleSensor (setName s) (nd Delay (setCycles 2)))");
  setProperty(lab.kernel.create("AgentTiming", "/sys/server/gamecontrol/timing"), "agentStep", 0.06);
  lab.run(9);  // turns in cycles 4, 7, 10
  CHECK(lab.sensed() == "(C (n s) (v 4.00 4.00))");
  CHECK(lab.sense() == "(C (n s) (v 7.00 7.00))");
  CHECK(lab.sense() == "(C (n s) (v 7.00 7.00))");
}

TEST_CASE("An action has the dead time of its effector, to the cycle") {
  Lab lab(robot("(nd Recorder (setName motor) (nd Delay (setCycles 2))) (nd Recorder (setName exact))"));
  CHECK(lab.act("(motor 1.5)(motor 2)(exact 1)") == "");
  CHECK(lab.act("(motor 3)") == "");
  CHECK(lab.act("") == "");
  CHECK(lab.act("") == "(motor 1.5)(motor 2)");
  CHECK(lab.act("") == "(motor 3)");
  CHECK(lab.act("") == "");
}

TEST_CASE("Gain, backlash, saturation and noise of an effector") {
  SECTION("gain and saturation") {
    Lab lab(robot("(nd Recorder (setName motor) (nd Gain (setGain 0.5)) (nd Saturation (setMost 2)))"));
    lab.act("(motor 3 9 x)");
    CHECK(lab.act("(motor -1)") == "(motor 1.50 2.00 x)");
    CHECK(lab.act("") == "(motor -0.50)");
    CHECK(lab.act("") == "");
  }
  SECTION("backlash") {
    Lab lab(robot("(nd Recorder (setName motor) (nd Backlash (setWidth 1) (setIndices 0)))"));
    std::string all;
    for (const char* action : {"(motor 0 5)", "(motor 1 6)", "(motor 0.5 7)", "(motor 0 8)(motor -1 9)", "", ""})
      all += lab.act(action);
    CHECK(all == "(motor 0.00 5)(motor 0.50 6)(motor 0.50 7)(motor 0.50 8)(motor -0.50 9)");
  }
  SECTION("noise") {
    Lab lab(robot("(nd Recorder (setName motor) (nd WhiteNoise (setSigma 0.1)))"));
    std::vector<double> errors;
    for (int i = 0; i < 2000; ++i) {
      lab.act("(motor 3)");
      if (i > 0) errors.push_back((*static_cast<Recorder&>(lab.part("motor")).done.begin()).at(1).number() - 3);
    }
    double sum = 0, squares = 0;
    for (const double e : errors) sum += e, squares += e * e;
    CHECK(std::abs(sum / 2000) < 0.01);
    CHECK(std::abs(std::sqrt(squares / 2000) - 0.1) < 0.008);
  }
}

TEST_CASE("A modifier of one's own is a class with one function") {
  Lab lab(robot("(nd Recorder (setName motor))"));
  lab.kernel.registerClass<DeadZone>();
  setProperty(static_cast<Node&>(lab.part("motor")).create("DeadZone", "friction"), "width", 0.1);
  lab.act("(motor 0.05 -0.05 0.2)");
  CHECK(lab.act("") == "(motor 0.00 0.00 0.20)");
}

TEST_CASE("Effectors with modifiers act after those without, in order of their predicates") {
  Lab lab(robot("(nd Recorder (setName b) (nd Gain)) (nd Recorder (setName a) (nd Gain)) (nd Recorder (setName c))"));
  lab.act("(b 1)(a 1)(c 1)", "a");
  CHECK(lab.act("", "b") == "(b 1.00)");
  CHECK(lab.act("", "a") == "");
}

TEST_CASE("With any number of threads the agents sense the same") {
  Lab one(kNoisy, 6, 1), four(kNoisy, 6, 4);
  CHECK(senses(one, 200) == senses(four, 200));
  CHECK(one.hash() == four.hash());
}

TEST_CASE("Two agents have errors of their own") {
  Lab lab(kNoisy, 2);
  lab.run(20);
  CHECK(lab.sensed(1) != lab.sensed(2));
}

TEST_CASE("The saved state of agents with modifiers is restored in another simulation, which goes on bit for bit") {
  Lab one(kNoisy, 2), other(kNoisy, 2);
  senses(one, 61), senses(other, 24);
  CHECK(one.hash() != other.hash());
  const std::string saved = one.save();
  other.load(saved);
  CHECK(other.hash() == one.hash());
  CHECK((other.save() == saved));
  CHECK(senses(one, 80) == senses(other, 80));
  CHECK(one.hash() == other.hash());
}

TEST_CASE("A modifier that throws ends its perceptor, and the log names both") {
  Lab lab("(nd CycleSensor (setName s)) (nd CycleSensor (setName t))");
  lab.kernel.registerClass<Broken>();
  lab.kernel.root().require<Node>("/usr/scene/AgentAspect1/s").create("Broken", "bad");
  CHECK(lab.sense() == "(C (n t) (v 4.00 4.00))");
  CHECK(lab.sense() == "(C (n t) (v 5.00 5.00))");
  CHECK_THAT(lab.text,
             Catch::Contains("/usr/scene/AgentAspect1/s (CycleSensor) threw and is asked no more: its modifier "
                             "bad (Broken) threw: no more"));
}

TEST_CASE("A modifier that throws loses the actions of its effector, and the log names both") {
  Lab lab(robot("(nd Recorder (setName motor))"));
  lab.kernel.registerClass<Broken>();
  lab.kernel.root().require<Node>("/usr/scene/AgentAspect1/motor").create("Broken", "bad");
  lab.act("(motor 1)");
  CHECK(lab.act("(motor 2)") == "");
  CHECK(lab.act("") == "");
  CHECK_THAT(lab.text,
             Catch::Contains("/usr/scene/AgentAspect1/motor (Recorder): its modifier bad (Broken) threw: no more"));
  CHECK(lab.kernel.faults() == 2);
}
