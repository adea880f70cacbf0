#include "option_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::mjcf {

void readOption(Attributes& a, Model& model, Unsupported& unsupported) {
  const Element& e = a.element();
  const auto set = [&](const char* property, Value v, bool ofMujoco = true) {
    model.options.push_back({e, property, std::move(v), ofMujoco});
  };
  const auto number = [&](const char* name, double least, bool ofMujoco = true) {
    if (!a.has(name)) return;
    const double v = a.number(name, 0);
    if (v < least) throw e.error(fmt::format("expected at least {} for '{}' of <option>, found {}", least, name, v));
    set(name, v, ofMujoco);
  };
  const auto vector = [&](const char* name, bool ofMujoco) {
    if (Vec3 v = Vec3::Zero(); a.take(name, v)) set(name, List{v.x(), v.y(), v.z()}, ofMujoco);
  };
  vector("gravity", false);
  vector("wind", true);
  number("timestep", 1e-6, false);
  number("tolerance", 0);
  number("impratio", 1e-6);
  number("density", 0);
  number("viscosity", 0);
  if (a.has("iterations")) set("iterations", std::max(1, a.integer("iterations", 100)));
  if (a.has("cone")) set("cone", a.word("cone", {"pyramidal", "elliptic"}, ""));
  if (a.has("solver")) set("solver", a.word("solver", {"PGS", "CG", "Newton"}, ""));
  if (a.has("integrator")) {
    const std::string wanted = a.word("integrator", {"Euler", "RK4", "implicit", "implicitfast"}, "");
    const std::string taken = wanted == "implicitfast" ? "implicit" : wanted;
    if (wanted != taken)
      unsupported.add(e, fmt::format("the integrator {} is not supported; {} is used in its place", wanted, taken));
    set("integrator", taken);
  }
  if (a.has("noslip_iterations")) set("noslipIterations", std::max(0, a.integer("noslip_iterations", 0)));
  if (a.has("mpr_iterations")) set("mprIterations", std::max(1, a.integer("mpr_iterations", 50)));
  if (a.has("noslip_tolerance")) set("noslipTolerance", a.number("noslip_tolerance", 0));
  if (a.has("mpr_tolerance")) set("mprTolerance", a.number("mpr_tolerance", 0));
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
