#pragma once
/// \file
/// The same problem without a host: plain ODE calls on the bodies, joints and geoms of an instance.
///
/// The raw side takes these over once from the engine and the collision detection: the ids of world, spaces, bodies,
/// geoms and joints; which geoms collide; the precomputed surface of each pair of materials. It attaches the geoms to
/// their bodies, which the host does not do. Then a cycle is what an ODE programmer would write: forces, motors,
/// dSpaceCollide with a near callback that makes contact joints, dWorldStep, dJointGroupEmpty. ODE's own auto-disable
/// is on if the instance's is.

#include <ode/ode.h>

#include <chrono>
#include <memory>
#include <vector>

#include "house.h"

namespace spark::bench {

/// The physics of an instance, stepped with plain ODE. The instance itself must no longer be stepped.
class RawWorld {
 public:
  /// Takes over an instance in its current state. It must use the dense solver, have been stepped before, and outlive
  /// this object.
  explicit RawWorld(Instance& instance);
  ~RawWorld();
  /// Gives all bodies the pose, the velocity and the sleep state of those of an equal instance.
  void follow(Instance& instance);
  void run(std::int64_t cycles);
  /// Numbers of bodies, of awake bodies, of joints, and of contact joints in the last cycle.
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
    std::vector<const Geom*> never;  ///< geoms with which it must not collide
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
  /// The model of an instance, and ODE's objects with the same indices.
  struct Source;
  void takeBodies(const Source& from);
  void takeGeoms(const Source& from);
  void takeSurfaces(const Source& from);
  void takeDrags(Instance& instance, const Source& from);
  void takeMotors(Instance& instance, const Source& from);
  void takeDrivers(Instance& instance, const Source& from);
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
