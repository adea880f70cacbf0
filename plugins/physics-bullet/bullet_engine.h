#pragma once
/// \file
/// Bullet as an engine of the physics server.

#include "bullet_solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// Rigid bodies by Bullet. It detects its own contacts.
class BulletEngine : public Leaf, public engine::IEngine {
  SPARK_CLASS(BulletEngine, Leaf)
 public:
  static constexpr engine::Capabilities kCapabilities{
      .armature = true, .detects = true, .bodyMeshes = false, .laws = true, .damping = true};
  static void describe(Description<BulletEngine>& d) {
    d.doc("Rigid bodies and contacts by Bullet, in coordinates of joints.");
    engine::describeEngine(d);
    d.property("version", &BulletEngine::version).doc("Version of the library.");
    d.property("direct", &BulletEngine::direct_)
        .range(0, 10000)
        .doc("Largest number of rows of constraints of an island that are solved directly; else by iterations.");
    d.property("iterations", &BulletEngine::iterations_)
        .range(1, 10000)
        .doc("Largest number of iterations over contacts, motors and stops in a step.");
    d.property("tolerance", &BulletEngine::tolerance_)
        .range(0, 1e6)
        .doc("Iterations end when they change no velocity by more than this [m/s or rad/s].");
  }
  Leaf& leaf() override { return *this; }
  engine::Capabilities capabilities() const override { return kCapabilities; }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override {
    return std::make_unique<bullet::BulletSolver>(direct_, iterations_, tolerance_);
  }

 private:
  std::string version() const { return fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100); }
  int direct_ = 1000, iterations_ = 300;
  double tolerance_ = 1e-6;
};

}  // namespace spark
