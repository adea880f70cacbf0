#include "option_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::mjcf {

void readOption(Attributes& a, Model& model, Unsupported& unsupported) {
  const Element& e = a.element();
  const auto set = [&](const char* property, Value v) { model.options.push_back({e, property, std::move(v)}); };
  const auto number = [&](const char* name, const char* property, double least) {
    if (!a.has(name)) return;
    const double v = a.number(name, 0);
    if (v < least) throw e.error(fmt::format("expected at least {} for '{}' of <option>, found {}", least, name, v));
    set(property, v);
  };
  const auto vector = [&](const char* name, const char* property) {
    if (Vec3 v = Vec3::Zero(); a.take(name, v)) set(property, List{v.x(), v.y(), v.z()});
  };
  vector("gravity", "gravity");
  vector("wind", "mujocoWind");
  number("timestep", "timestep", 1e-6);
  number("tolerance", "mujocoTolerance", 0);
  number("impratio", "mujocoImpratio", 1e-6);
  number("density", "mujocoDensity", 0);
  number("viscosity", "mujocoViscosity", 0);
  if (a.has("iterations")) set("mujocoIterations", std::max(1, a.integer("iterations", 100)));
  if (a.has("cone")) set("mujocoCone", a.word("cone", {"pyramidal", "elliptic"}, ""));
  if (a.has("solver")) set("mujocoSolver", a.word("solver", {"PGS", "CG", "Newton"}, ""));
  if (a.has("integrator")) {
    const std::string wanted = a.word("integrator", {"Euler", "RK4", "implicit", "implicitfast"}, "");
    const std::string taken = wanted == "RK4" ? "Euler" : wanted == "implicitfast" ? "implicit" : wanted;
    if (wanted != taken)
      unsupported.add(e, fmt::format("the integrator {} is not supported; {} is used in its place", wanted, taken));
    set("mujocoIntegrator", taken);
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
  if (!on("constraint")) f.contact = f.limit = f.frictionLoss = false;
  const auto set = [&](const char* property, Value v) { model.options.push_back({e, property, std::move(v)}); };
  if (!on("gravity")) set("gravity", List{0.0, 0.0, 0.0});
  if (!f.passive) set("mujocoDensity", 0.0), set("mujocoViscosity", 0.0);
  const auto refuse = [&](const char* name, bool is, const char* value) {
    if (is) unsupported.add(e, fmt::format("the flag {}=\"{}\" is not supported", name, value));
  };
  if (!on("filterparent")) set("joinedCollide", true);
  for (const char* const name : {"refsafe", "nativeccd", "eulerdamp", "midphase"}) refuse(name, !on(name), "disable");
  for (const char* const name : {"override", "multiccd", "invdiscrete", "island"})
    refuse(name, on(name, "disable"), "enable");
  // Without effect here: there is nothing that they switch, or results are the same.
  a.ignore({"equality", "warmstart", "sensor", "energy", "fwdinv", "sensornoise", "autoreset"});
  a.finish();
}

}  // namespace spark::mjcf
