#pragma once
/// \file
/// Reads the actuators of an MJCF model.

#include "compiler.h"
#include "robot/model.h"

namespace spark::mjcf {

/// Reads actuators with their chains of defaults. Its parts must outlive it.
class ActuatorReader {
 public:
  ActuatorReader(const Compiler& compiler, const Defaults& defaults, Unsupported& unsupported)
      : compiler_(compiler), defaults_(defaults), unsupported_(unsupported) {}
  /// Reads an element in `actuator`; nullopt for one that is not supported. Throws Error.
  std::optional<Actuator> read(const Element& e);

 private:
  /// The functions and limits of an actuator, as its chain of elements leaves them.
  struct Functions {
    double gear = 1;
    std::array<double, 10> gain{1}, bias{};
    std::string gainType = "fixed", biasType = "none", dynamics = "none";
    Limit control, force;
  };
  void apply(const Element& e, Functions& f);
  /// Why the actuator of an element is not supported; "" if it is.
  std::string refusal(const Element& e, const Functions& f) const;
  bool applyLaw(Attributes& a, Functions& f);
  void applyGeneral(Attributes& a, Functions& f);

  const Compiler& compiler_;
  const Defaults& defaults_;
  Unsupported& unsupported_;
};

}  // namespace spark::mjcf
