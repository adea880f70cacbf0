#pragma once
/// \file
/// Equalities, tendons, actuators and pairs as MJCF text.

#include <mujoco/mjmodel.h>

#include "mjcf.h"
#include "mujoco_actuators.h"

namespace spark::mujoco {

/// The constraints of a model whose bodies and joints are all there.
class Constraints {
 public:
  Constraints(const engine::Model& model, const Trees& trees);
  /// The sites of tendons and actuators in a body, or with kNone in the world, and the geometry that tendons go around.
  std::string sites(Index body) const;
  /// The sections `contact`, `equality` and `tendon`.
  std::string text() const;
  /// The elements of the section `actuator`.
  std::string actuators() const { return actuators_ + dynamicActuators_; }
  /// The numbers of those that are left out: what they name is not there, is there twice, or has not one coordinate.
  const std::vector<int>& skipped() const { return skipped_; }

 private:
  /// A body of MuJoCo, which may be a part of one of the model's; "" if there is none. 0: the world.
  std::string body(std::uint64_t id, std::int64_t part = 0) const;
  /// A joint with one coordinate in MuJoCo; "" if there is none.
  std::string joint(std::uint64_t id) const;
  /// A body, or a joint or a ball; "" if there is none.
  std::string jointOfActuator(const ActuatorNumbers& n) const;
  std::string tendon(std::uint64_t target) const;
  void add(int number, const EqualityNumbers& n);
  void add(int number, const TendonNumbers& n);
  void add(int number, const ActuatorNumbers& n);
  void add(int number, const PairNumbers& n);
  void put(std::uint64_t body, const std::string& text);

  const engine::Model& model_;
  std::vector<std::uint8_t> hasBody_, hasJoint_;  ///< by body and joint of the model: MuJoCo has it
  std::string equalities_, tendons_, actuators_, dynamicActuators_, pairs_;
  std::vector<int> made_;  ///< numbers of the tendons that are there
  std::vector<std::pair<Index, std::string>> sites_;
  std::vector<int> skipped_;
};

/// The name of an actuator.
std::string actuatorName(int number);

/// Writes points and rotations of equalities, and lengths of springs, to a compiled model: MuJoCo's compiler finds some
/// of them from the poses in the text, which of free bodies are the present ones, and takes no length below 0.
void placeConstraints(const engine::Model& model, mjModel& compiled);

}  // namespace spark::mujoco
