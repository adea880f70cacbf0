#include "actuator_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::mjcf {

namespace {

/// In MuJoCo the actuators of all tags share one default, so each tag's elements of a default class apply to all.
constexpr std::string_view kTags[] = {"general", "motor",    "position", "velocity", "intvelocity",
                                      "damper",  "cylinder", "muscle",   "adhesion"};

}  // namespace

std::optional<Actuator> ActuatorReader::read(const Element& e) {
  Actuator x;
  x.from = e;
  x.name = e.node.attribute("name").value();
  x.joint = e.node.attribute("joint").value();
  std::vector<Element> chain{e};
  defaults_.forEach(e, kTags, e.node.attribute("class").value(), [&](const Element& d) { chain.push_back(d); });
  // The outermost default comes first. A later element may lift the refusal of an earlier one.
  std::string refusal;
  for (std::size_t i = chain.size(); i-- > 0;) apply(chain[i], x, refusal);
  if (refusal.empty() && x.joint.empty()) refusal = fmt::format("a <{}> that acts on no joint is left out", e.tag());
  if (!refusal.empty()) {
    leftOver_.add(e, refusal);
    return std::nullopt;
  }
  x.maxForce = x.gear == 0 ? 0 : std::abs(x.gear) * x.forceRange;
  return x;
}

/// Applies what one element says. `refusal`: why the actuator is left out, "" if it is not.
void ActuatorReader::apply(const Element& e, Actuator& x, std::string& refusal) {
  Attributes a(e, leftOver_);
  std::array<double, 6> gear{x.gear, 0, 0, 0, 0, 0};
  a.fill("gear", gear);
  x.gear = gear[0];
  applyLaw(a, x, refusal);
  applyLimits(a, x);
  a.ignore({"name", "class", "joint", "group", "user", "tendon", "site", "body", "jointinparent", "cranksite",
            "slidersite"});
  if (refusal.empty()) a.finish();
}

void ActuatorReader::applyLaw(Attributes& a, Actuator& x, std::string& refusal) {
  const std::string_view tag = a.element().tag();
  if (tag == "motor") {
    x.gain = 1, x.bias = {0, 0, 0}, refusal.clear();
  } else if (tag == "position") {
    x.gain = a.number("kp", x.gain);
    x.bias = {0, -x.gain, -a.number("kv", 0)}, refusal.clear();
  } else if (tag == "velocity") {
    x.gain = a.number("kv", x.gain);
    x.bias = {0, 0, -x.gain}, refusal.clear();
  } else if (tag == "general") {
    applyGeneral(a, x, refusal);
  } else {
    refusal = fmt::format("the element <{}> is left out", tag);
  }
}

void ActuatorReader::applyGeneral(Attributes& a, Actuator& x, std::string& refusal) {
  std::array<double, 10> gain{x.gain}, bias{x.bias[0], x.bias[1], x.bias[2]};
  a.fill("gainprm", gain);
  a.fill("biasprm", bias);
  x.gain = gain[0];
  const bool affine = x.bias != std::array<double, 3>{};
  const std::string kind = a.word("biastype", {"none", "affine", "muscle", "user"}, affine ? "affine" : "none");
  x.bias = kind == "affine" ? std::array<double, 3>{bias[0], bias[1], bias[2]} : std::array<double, 3>{};
  if (a.word("gaintype", {"fixed", "affine", "muscle", "user"}, "fixed") != "fixed" ||
      a.text("dyntype", "none") != "none" || kind == "muscle" || kind == "user")
    refusal = "a <general> whose gain is not fixed, or that has dynamics, is left out";
  a.ignore({"dynprm"});
}

void ActuatorReader::applyLimits(Attributes& a, Actuator& x) {
  const auto control = a.numbers("ctrlrange", 2, 2), force = a.numbers("forcerange", 2, 2);
  if (compiler_.limited(a, "ctrllimited", "ctrlrange", control)) x.controlRange = {(*control)[0], (*control)[1]};
  if (!compiler_.limited(a, "forcelimited", "forcerange", force)) return;
  x.forceRange = std::max(std::abs((*force)[0]), std::abs((*force)[1]));
  if ((*force)[0] != -(*force)[1])
    leftOver_.add(a.element(), "a force range that is not symmetric is taken as symmetric");
}

}  // namespace spark::mjcf
