#pragma once
/// \file
/// Reads the actuators of an MJCF model.

#include "compiler.h"
#include "model.h"

namespace spark::mjcf {

/// Reads actuators with their chains of defaults. Its parts must outlive it.
class ActuatorReader {
 public:
  ActuatorReader(const Compiler& compiler, const Defaults& defaults, LeftOver& leftOver)
      : compiler_(compiler), defaults_(defaults), leftOver_(leftOver) {}
  /// Reads an element in `actuator`; nullopt for one that is left out. Throws Error.
  std::optional<Actuator> read(const Element& e);

 private:
  void apply(const Element& e, Actuator& x, std::string& refusal);
  void applyLaw(Attributes& a, Actuator& x, std::string& refusal);
  void applyGeneral(Attributes& a, Actuator& x, std::string& refusal);
  void applyLimits(Attributes& a, Actuator& x);

  const Compiler& compiler_;
  const Defaults& defaults_;
  LeftOver& leftOver_;
};

}  // namespace spark::mjcf
