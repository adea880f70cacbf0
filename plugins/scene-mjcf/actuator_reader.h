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
    std::array<double, 6> gear{1, 0, 0, 0, 0, 0};
    std::array<double, 10> gain{1}, bias{}, dynamicsNumbers{1};
    std::string gainType = "fixed", biasType = "none", dynamics = "none";
    Limit control, force, activation;
    std::array<double, 2> lengthRange{};
    double crankLength = 0;
  };
  void apply(const Element& e, Functions& f);
  /// Why the actuator of an element is not supported; "" if it is.
  std::string refusal(const Element& e, const Functions& f) const;
  void readTarget(const Element& e, Actuator& x) const;
  bool applyLaw(Attributes& a, Functions& f);
  void applyGeneral(Attributes& a, Functions& f);
  static void applyMuscle(Attributes& a, Functions& f);

  const Compiler& compiler_;
  const Defaults& defaults_;
  Unsupported& unsupported_;
};

}  // namespace spark::mjcf
