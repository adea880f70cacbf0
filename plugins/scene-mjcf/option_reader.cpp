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
    const std::string taken = wanted == "RK4" ? "Euler" : wanted == "implicitfast" ? "implicit" : wanted;
    if (wanted != taken)
      unsupported.add(e, fmt::format("the integrator {} is not supported; {} is used in its place", wanted, taken));
    set("integrator", taken);
  }
  a.ignore({"jacobian"});
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
  for (const char* const name : {"refsafe", "nativeccd", "eulerdamp", "midphase"}) refuse(name, !on(name), "disable");
  for (const char* const name : {"override", "multiccd", "invdiscrete", "island"})
    refuse(name, on(name, "disable"), "enable");
  // Without effect here: there is nothing that they switch, or results are the same.
  a.ignore({"warmstart", "sensor", "energy", "fwdinv", "autoreset"});
  a.finish();
}

}  // namespace spark::mjcf
