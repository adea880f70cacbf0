#include "option_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::mjcf {

void readOption(Attributes& a, Model& model, Unsupported& unsupported) {
  const Element& e = a.element();
  const auto set = [&](const char* property, Value v, bool ofMujoco = true) {
    model.options.push_back({e, property, std::move(v), ofMujoco});
  };
  const auto number = [&](const char* name, double most, const char* property) {
    if (a.has(name)) set(property, a.within(name, 0, 0, most));
  };
  // MuJoCo has no contacts with an impratio of 0 or less, and no time or one that runs backwards with such a timestep.
  const auto positive = [&](const char* name, double least, bool ofMujoco) {
    if (!a.has(name)) return;
    const double v = a.number(name, 0);
    if (v >= least) return set(name, v, ofMujoco);
    a.note(fmt::format("'{}' of <option> is ignored: expected {} or more, found {}", name, least, v));
  };
  const auto count = [&](const char* name, int least, const char* property) {
    constexpr int kMost = 10000;
    if (!a.has(name)) return;
    const int n = a.integer(name, least);
    if (n > kMost) a.note(fmt::format("'{}' of <option> is taken as {}, found {}", name, kMost, n));
    set(property, std::clamp(n, least, kMost));
  };
  const auto vector = [&](const char* name, bool ofMujoco) {
    if (Vec3 v = Vec3::Zero(); a.take(name, v)) set(name, List{v.x(), v.y(), v.z()}, ofMujoco);
  };
  vector("gravity", false);
  vector("wind", true);
  positive("timestep", 1e-6, false);
  positive("impratio", 1e-6, true);
  number("tolerance", 1, "tolerance");
  number("density", HUGE_VAL, "density");
  number("viscosity", HUGE_VAL, "viscosity");
  number("noslip_tolerance", 1, "noslipTolerance");
  number("mpr_tolerance", 1, "mprTolerance");
  count("iterations", 1, "iterations");
  count("noslip_iterations", 0, "noslipIterations");
  count("mpr_iterations", 1, "mprIterations");
  if (a.has("cone")) set("cone", a.word("cone", {"pyramidal", "elliptic"}, ""));
  if (a.has("solver")) set("solver", a.word("solver", {"PGS", "CG", "Newton"}, ""));
  if (a.has("integrator")) {
    const std::string wanted = a.word("integrator", {"Euler", "RK4", "implicit", "implicitfast"}, "");
    const std::string taken = wanted == "implicitfast" ? "implicit" : wanted;
    if (wanted != taken)
      unsupported.add(e, fmt::format("the integrator {} is not supported; {} is used in its place", wanted, taken));
    set("integrator", taken);
  }
  if (a.has("o_margin")) set("overrideMargin", a.number("o_margin", 0));
  const auto numbers = [&](const char* name, const char* property, auto values) {
    if (!a.has(name)) return;
    a.fill(name, values);
    set(property, List(values.begin(), values.end()));
  };
  numbers("o_solref", "overrideSolref", std::array{0.02, 1.0});
  numbers("o_solimp", "overrideSolimp", std::array{0.9, 0.95, 0.001, 0.5, 2.0});
  const std::string collision = a.word("collision", {"all", "predefined", "dynamic"}, "all");
  if (a.has("collision")) model.collision = collision;
  a.ignore({"jacobian", "apirate", "magnetic"});
  a.finish();
}

void readFlags(Attributes& a, Model& model, Unsupported& unsupported) {
  const Element& e = a.element();
  const auto on = [&](const char* name, const char* usual = "enable") {
    return a.word(name, {"enable", "disable"}, usual) == "enable";
  };
  Flags& f = model.flags;
  f.contact = f.contact && on("contact");
  f.limit = f.limit && on("limit");
  f.frictionLoss = f.frictionLoss && on("frictionloss");
  f.passive = f.passive && on("passive");
  f.actuation = f.actuation && on("actuation");
  f.clampControl = f.clampControl && on("clampctrl");
  f.equality = f.equality && on("equality");
  f.sensorNoise = f.sensorNoise || on("sensornoise", "disable");
  if (!on("constraint")) f.contact = f.limit = f.frictionLoss = f.equality = false;
  const auto set = [&](const char* property, Value v, bool ofMujoco = false) {
    model.options.push_back({e, property, std::move(v), ofMujoco});
  };
  if (!on("gravity")) set("gravity", List{0.0, 0.0, 0.0});
  if (!f.passive) set("density", 0.0, true), set("viscosity", 0.0, true);
  const auto refuse = [&](const char* name, bool is, const char* value) {
    if (is) unsupported.add(e, fmt::format("the flag {}=\"{}\" is not supported", name, value));
  };
  if (!on("filterparent")) set("joinedCollide", true);
  if (!on("refsafe")) set("refsafe", false, true);
  if (on("override", "disable")) set("overrides", true, true);
  if (on("multiccd", "disable")) set("multiccd", true, true);
  for (const char* const name : {"nativeccd", "eulerdamp", "midphase"}) refuse(name, !on(name), "disable");
  for (const char* const name : {"invdiscrete", "island"}) refuse(name, on(name, "disable"), "enable");
  // Without effect here: there is nothing that they switch, or results are the same.
  a.ignore({"warmstart", "sensor", "energy", "fwdinv", "autoreset"});
  a.finish();
}

}  // namespace spark::mjcf
