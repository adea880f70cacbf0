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
  // The coordinate of a hinge or slider is the same in both frames.
  for (const char* const target : {"joint", "jointinparent"})
    if (x.joint.empty()) x.joint = e.node.attribute(target).value();
  std::vector<Element> chain{e};
  defaults_.forEach(e, kTags, e.node.attribute("class").value(), [&](const Element& d) { chain.push_back(d); });
  // The outermost default comes first, since later elements override.
  Functions f;
  for (std::size_t i = chain.size(); i-- > 0;) apply(chain[i], f);
  std::string refused = refusal(e, f);
  if (refused.empty() && x.joint.empty())
    refused = fmt::format("{} does not act on a joint, which is not supported", e.named());
  if (!refused.empty()) {
    unsupported_.add(e, refused);
    return std::nullopt;
  }
  // Limits count once all defaults are applied.
  x.gear = f.gear;
  const bool affine = f.gainType == "affine";
  x.gain = {f.gain[0], affine ? f.gain[1] : 0, affine ? f.gain[2] : 0};
  if (f.biasType == "affine") x.bias = {f.bias[0], f.bias[1], f.bias[2]};
  if (const auto range = compiler_.limit(e, "ctrlrange", f.control)) x.controlRange = *range;
  if (const auto range = compiler_.limit(e, "forcerange", f.force)) x.forceRange = *range;
  return x;
}

std::string ActuatorReader::refusal(const Element& e, const Functions& f) const {
  for (const std::string_view tag : {"intvelocity", "cylinder", "muscle", "adhesion", "plugin"})
    if (e.tag() == tag) return fmt::format("the actuator {} is not supported", e.named());
  if (f.dynamics != "none")
    return fmt::format("{} has the dyntype '{}', which is not supported", e.named(), f.dynamics);
  for (const std::string& type : {f.gainType, f.biasType})
    if (type == "muscle" || type == "user")
      return fmt::format("{} is of the type '{}', which is not supported", e.named(), type);
  return "";
}

void ActuatorReader::apply(const Element& e, Functions& f) {
  Attributes a(e, unsupported_);
  std::array<double, 6> gear{f.gear, 0, 0, 0, 0, 0};
  a.fill("gear", gear);
  f.gear = gear[0];
  f.control.read(a, "ctrllimited", "ctrlrange");
  f.force.read(a, "forcelimited", "forcerange");
  a.ignore({"name", "class", "joint", "group", "user", "tendon", "site", "body", "jointinparent", "cranksite",
            "slidersite", "lengthrange"});
  if (applyLaw(a, f)) a.finish();
}

/// What MuJoCo's shortcuts mean; each leaves what it does not name. Returns false for an unsupported one.
bool ActuatorReader::applyLaw(Attributes& a, Functions& f) {
  const std::string_view tag = a.element().tag();
  const auto types = [&](const char* gain, const char* bias, const char* dynamics) {
    f.gainType = gain, f.biasType = bias, f.dynamics = dynamics;
  };
  if (tag == "motor") {
    f.gain = {1};
    types("fixed", "none", "none");
  } else if (tag == "position") {
    f.gain = {a.number("kp", f.gain[0])};
    f.bias = {0, -f.gain[0], -a.number("kv", 0)};
    types("fixed", "affine", "none");
  } else if (tag == "velocity") {
    f.gain = {a.number("kv", f.gain[0])};
    f.bias = {0, 0, -f.gain[0]};
    types("fixed", "affine", "none");
  } else if (tag == "damper") {  // a damping that is proportional to the control
    f.gain = {0, 0, -a.number("kv", 0)};
    f.control.word = "true";
    types("affine", "none", "none");
  } else if (tag == "general") {
    applyGeneral(a, f);
  } else {
    types("fixed", "affine", tag == "intvelocity" ? "integrator" : tag == "cylinder" ? "filter" : "none");
    return false;
  }
  return true;
}

void ActuatorReader::applyGeneral(Attributes& a, Functions& f) {
  a.fill("gainprm", f.gain);
  a.fill("biasprm", f.bias);
  f.gainType = a.word("gaintype", {"fixed", "affine", "muscle", "user"}, f.gainType.c_str());
  f.biasType = a.word("biastype", {"none", "affine", "muscle", "user"}, f.biasType.c_str());
  f.dynamics = a.text("dyntype", f.dynamics.c_str());
  a.ignore({"dynprm", "actlimited", "actrange"});
}

}  // namespace spark::mjcf
