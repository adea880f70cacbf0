#pragma once
/// \file
/// Equalities and tendons as MJCF text.

#include <mujoco/mjmodel.h>

#include "mjcf.h"
#include "mujoco_constraints.h"

namespace spark::mujoco {

/// The constraints of a model whose bodies and joints are all there.
class Constraints {
 public:
  Constraints(const engine::Model& model, const Trees& trees);
  /// The sites of tendons in a body, or with kNone in the world.
  std::string sites(Index body) const;
  /// The sections `equality` and `tendon`.
  std::string text() const;
  /// The numbers of those that are left out: what they name is not there, is there twice, or has not one coordinate.
  const std::vector<int>& skipped() const { return skipped_; }

 private:
  /// A body of MuJoCo, which may be a part of one of the model's; "" if there is none. 0: the world.
  std::string body(std::uint64_t id, std::int64_t part = 0) const;
  /// A joint with one coordinate in MuJoCo; "" if there is none.
  std::string joint(std::uint64_t id) const;
  void add(int number, const EqualityNumbers& n);
  void add(int number, const TendonNumbers& n);

  const engine::Model& model_;
  std::vector<std::uint8_t> hasBody_, hasJoint_;  ///< by body and joint of the model: MuJoCo has it
  std::string equalities_, tendons_;
  std::vector<std::pair<Index, std::string>> sites_;
  std::vector<int> skipped_;
};

/// Writes points and rotations of equalities, and lengths of springs, to a compiled model: MuJoCo's compiler finds some
/// of them from the poses in the text, which of free bodies are the present ones, and takes no length below 0.
void placeConstraints(const engine::Model& model, mjModel& compiled);

}  // namespace spark::mujoco
