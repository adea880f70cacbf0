#pragma once
/// \file
/// The same problem without a host: plain ODE calls on the bodies, joints and geoms that a house made.
///
/// Taken over once from the engine and the collision detection: ids of world, spaces, bodies, geoms, joints; which
/// geoms collide; the surface of each pair of materials, combined beforehand. Geoms are attached to their bodies, which
/// the host does not do. Then a cycle is what an ODE programmer would write: forces, motors, dSpaceCollide with a near
/// callback that makes contact joints, dWorldStep, dJointGroupEmpty. ODE's own auto-disable is on where the house's is.

#include <ode/ode.h>

#include <chrono>
#include <memory>
#include <vector>

#include "house.h"

namespace spark::bench {

/// A house's physics, stepped by hand. The house must not be stepped any more.
class RawWorld {
 public:
  /// Takes over a house with the dense solver that was stepped before, in its present state. The house must outlive it.
  explicit RawWorld(House& house);
  ~RawWorld();
  /// Puts all bodies where an equal house has them, as fast and as awake: both go on from one state.
  void follow(House& house);
  void run(std::int64_t cycles);
  /// Bodies, those awake, joints, and contact joints of the last cycle.
  int bodies() const { return static_cast<int>(bodyIds_.size()); }
  int awake() const;
  int joints() const { return joints_; }
  int contacts() const { return contacts_; }
  /// Mean wall time of collision and of the solver per cycle since the last call [us].
  std::pair<double, double> phases();

 private:
  struct Geom {
    std::size_t surface = 0;
    bool solid = false;
    std::vector<const Geom*> never;  ///< told not to collide with these
  };
  struct Drag {
    dBodyID body;
    double linear, angular;
  };
  struct Motor {
    dJointID joint;
    int axis;
    bool universal;
    int index;  ///< of the motor
  };
  struct Driver {
    dBodyID body;
    std::size_t agent;
    double factor;
  };
  /// The model of a house, and ODE's objects with the same indices.
  struct Source;
  void takeBodies(const Source& from);
  void takeGeoms(const Source& from);
  void takeSurfaces(const Source& from);
  void takeDrags(House& house, const Source& from);
  void takeMotors(House& house, const Source& from);
  void takeDrivers(House& house, const Source& from);
  void act();
  void near(dGeomID a, dGeomID b);
  static void nearCallback(void* self, dGeomID a, dGeomID b);

  dWorldID world_;
  dSpaceID root_;
  std::vector<dSpaceID> spaces_;
  dJointGroupID group_;
  std::vector<std::unique_ptr<Geom>> geoms_;
  std::vector<dSurfaceParameters> surfaces_;  ///< by surface of a times count plus surface of b
  std::size_t surfaceCount_ = 0;
  std::vector<Drag> drags_;
  std::vector<Motor> motors_;
  std::vector<Driver> drivers_;
  std::vector<dBodyID> bodyIds_;
  std::int64_t cycle_ = 0, timed_ = 0;
  int perPair_ = 4, joints_ = 0, contacts_ = 0;
  double step_ = 0.02;
  std::chrono::steady_clock::duration collide_{}, solve_{};
};

}  // namespace spark::bench
