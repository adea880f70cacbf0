#include "actuator_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace spark::mjcf {

namespace {

/// In MuJoCo the actuators of all tags share one default, so each tag's elements of a default class apply to all.
constexpr std::string_view kTags[] = {"general", "motor",    "position", "velocity", "intvelocity",
                                      "damper",  "cylinder", "muscle",   "adhesion"};

/// Throws Error for numbers of a muscle that MuJoCo does not take.
void checkMuscle(const Element& e, const std::array<double, 10>& n) {
  const bool positive = n[3] > 0 && n[6] > 0 && n[7] > 0 && n[8] > 0;
  if (!(n[0] < n[1] && positive && n[4] < 1 && n[5] > 1))
    throw e.error(fmt::format(
        "expected a lower and a higher number for the range, scale, vmax, fpmax and fvmax above 0, and lmin "
        "below and lmax above 1, found {:g}",
        fmt::join(n.begin(), n.begin() + 9, " ")));
}

}  // namespace

std::optional<Actuator> ActuatorReader::read(const Element& e) {
  Actuator x;
  x.from = e;
  x.name = e.node.attribute("name").value();
  readTarget(e, x);
  std::vector<Element> chain{e};
  defaults_.forEach(e, kTags, e.node.attribute("class").value(), [&](const Element& d) { chain.push_back(d); });
  // The outermost default comes first, since later elements override.
  Functions f;
  for (std::size_t i = chain.size(); i-- > 0;) apply(chain[i], f);
  std::string refused = refusal(e, f);
  if (refused.empty() && x.engine.target.empty())
    refused = fmt::format("{} acts on nothing: it is left out", e.named());
  if (!refused.empty()) {
    unsupported_.add(e, refused);
    return std::nullopt;
  }
  if (f.gainType == "muscle") checkMuscle(e, f.gain);
  if (f.biasType == "muscle") checkMuscle(e, f.bias);
  // Limits count once all defaults are applied.
  x.gear = f.gear[0];
  const bool affine = f.gainType == "affine";
  x.gain = {f.gain[0], affine ? f.gain[1] : 0, affine ? f.gain[2] : 0};
  if (f.biasType == "affine") x.bias = {f.bias[0], f.bias[1], f.bias[2]};
  Actuator::Engine& n = x.engine;
  n.gear = f.gear, n.crankLength = f.crankLength, n.lengthRange = f.lengthRange;
  n.dynamics = f.dynamics == "filterexact" ? "filter" : f.dynamics, n.gainType = f.gainType, n.biasType = f.biasType;
  n.dynamicsNumbers = f.dynamicsNumbers, n.gain = f.gain, n.bias = f.bias;
  if (f.dynamics == "filterexact")
    unsupported_.add(e, fmt::format("{} has the dyntype filterexact: 'filter' is used in its place", e.named()));
  Attributes a(e, unsupported_);
  if (const auto range = compiler_.limit(a, "actrange", f.activation)) n.activationRange = *range;
  if (const auto range = compiler_.limit(a, "ctrlrange", f.control)) x.controlRange = *range;
  if (const auto range = compiler_.limit(a, "forcerange", f.force)) x.forceRange = *range;
  return x;
}

/// What it acts on: of the attributes that say so the first one counts.
void ActuatorReader::readTarget(const Element& e, Actuator& x) const {
  const auto value = [&](const char* name) { return std::string(e.node.attribute(name).value()); };
  for (const auto& [attribute, type] :
       {std::pair{"joint", "joint"}, std::pair{"jointinparent", "jointinparent"}, std::pair{"tendon", "tendon"},
        std::pair{"site", "site"}, std::pair{"cranksite", "slidercrank"}, std::pair{"body", "body"}}) {
    if (value(attribute).empty()) continue;
    x.engine.type = type;
    x.engine.target = value(attribute);
    break;
  }
  // The coordinate of a hinge or slider is the same in both frames.
  if (x.engine.type == "joint" || x.engine.type == "jointinparent") x.joint = x.engine.target;
  x.engine.reference = value(x.engine.type == "site" ? "refsite" : "slidersite");
}

std::string ActuatorReader::refusal(const Element& e, const Functions& f) const {
  if (e.tag() == "plugin" || std::find(std::begin(kTags), std::end(kTags), e.tag()) == std::end(kTags))
    return fmt::format("the actuator {} is not supported", e.named());
  const auto among = [](const std::string& word, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (!among(f.dynamics, {"none", "integrator", "filter", "filterexact", "muscle"}))
    return fmt::format("{} has the dyntype '{}', which is not supported", e.named(), f.dynamics);
  if (!among(f.gainType, {"fixed", "affine", "muscle"}) || !among(f.biasType, {"none", "affine", "muscle"}))
    return fmt::format("{} has the gaintype '{}' and the biastype '{}', which are not supported", e.named(), f.gainType,
                       f.biasType);
  return "";
}

void ActuatorReader::apply(const Element& e, Functions& f) {
  Attributes a(e, unsupported_);
  a.fill("gear", f.gear);
  f.control.read(a, "ctrllimited", "ctrlrange");
  f.force.read(a, "forcelimited", "forcerange");
  f.activation.read(a, "actlimited", "actrange");
  a.take("lengthrange", f.lengthRange);
  f.crankLength = a.number("cranklength", f.crankLength);
  a.ignore({"name", "class", "joint", "group", "user", "tendon", "site", "body", "jointinparent", "cranksite",
            "slidersite", "refsite"});
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
  } else if (tag == "intvelocity") {  // the target moves with the control
    f.gain = {a.number("kp", f.gain[0])};
    f.bias = {0, -f.gain[0]};
    f.activation.word = "true";
    types("fixed", "affine", "integrator");
  } else if (tag == "cylinder") {
    f.dynamicsNumbers = {a.number("timeconst", f.dynamicsNumbers[0])};
    f.gain = {a.number("area", f.gain[0])};
    if (const double d = a.number("diameter", 0); d > 0) f.gain[0] = kPi / 4 * d * d;
    std::array<double, 3> bias{f.bias[0], f.bias[1], f.bias[2]};
    a.fill("bias", bias);
    f.bias = {bias[0], bias[1], bias[2]};
    types("fixed", "affine", "filter");
  } else if (tag == "muscle") {
    applyMuscle(a, f);
    types("muscle", "muscle", "muscle");
  } else if (tag == "adhesion") {
    f.gain = {a.number("gain", f.gain[0])};
    f.control.word = "true";
    types("fixed", "none", "none");
  } else {
    return false;
  }
  return true;
}

void ActuatorReader::applyGeneral(Attributes& a, Functions& f) {
  a.fill("gainprm", f.gain);
  a.fill("biasprm", f.bias);
  f.gainType = a.word("gaintype", {"fixed", "affine", "muscle", "user", "dcmotor"}, f.gainType.c_str());
  f.biasType = a.word("biastype", {"none", "affine", "muscle", "user", "dcmotor"}, f.biasType.c_str());
  f.dynamics = a.text("dyntype", f.dynamics.c_str());
  a.fill("dynprm", f.dynamicsNumbers);
}

/// What it does not name is that of MuJoCo's muscles, where it is still that of all actuators.
void ActuatorReader::applyMuscle(Attributes& a, Functions& f) {
  constexpr std::array<double, 9> kMuscle{0.75, 1.05, -1, 200, 0.5, 1.6, 1.5, 1.3, 1.2};
  constexpr std::array<const char*, 7> kNames{"force", "scale", "lmin", "lmax", "vmax", "fpmax", "fvmax"};
  for (std::size_t i = 0; i < kMuscle.size(); ++i)
    if (f.gain[i] == (i == 0 ? 1 : 0)) f.gain[i] = kMuscle[i];
  std::array<double, 2> time{f.dynamicsNumbers[0] == 1 ? 0.01 : f.dynamicsNumbers[0],
                             f.dynamicsNumbers[1] == 0 ? 0.04 : f.dynamicsNumbers[1]},
      range{f.gain[0], f.gain[1]};
  a.fill("timeconst", time);
  a.fill("range", range);
  f.dynamicsNumbers[0] = time[0], f.dynamicsNumbers[1] = time[1];
  f.gain[0] = range[0], f.gain[1] = range[1];
  for (std::size_t i = 0; i < kNames.size(); ++i) f.gain[i + 2] = a.number(kNames[i], f.gain[i + 2]);
  f.bias = f.gain;
}

}  // namespace spark::mjcf
