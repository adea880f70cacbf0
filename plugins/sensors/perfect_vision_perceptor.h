#pragma once

#include <vector>

#include "api/agents.h"
#include "api/scene_calls.h"

namespace spark {

/// `(PerfectVision (box (pos 1.00 2.00 0.04)) ...)`: world positions of all transforms of its scene [m]. For demos.
class PerfectVisionPerceptor : public Perceptor, public ISceneCalls {
  SPARK_CLASS(PerfectVisionPerceptor, Perceptor)
 public:
  static void describe(Description<PerfectVisionPerceptor>& d) {
    d.doc("Senses the positions of all transforms of the scene: (PerfectVision (name (pos x y z)) ...) in m.");
    d.implements<ISceneCalls>();
    d.method("setInversion", &PerfectVisionPerceptor::setInversion)
        .parameters({"x", "y", "z"})
        .doc("Inverts the sign of the coordinates that are true.");
  }
  /// True inverts the sign of a coordinate.
  void setInversion(bool x, bool y, bool z) { signs_ = {x ? -1.f : 1.f, y ? -1.f : 1.f, z ? -1.f : 1.f}; }

  std::vector<SceneCall> sceneCalls() const override {
    if (signs_ == Vec3f(1, 1, 1)) return {};
    return {{"setInversion", {signs_.x() < 0, signs_.y() < 0, signs_.z() < 0}}};
  }
  void sense(Predicates& out, const Event&) override {
    if (tree_.changed(*this)) collect();
    out.open("PerfectVision");
    for (const Transform* t : transforms_) {
      const Vec3f p = positionOf(t->world()).cwiseProduct(signs_);
      out.open(t->name()).open("pos").add(p.x()).add(p.y()).add(p.z()).close().close();
    }
    out.close();
  }

 private:
  void collect() {
    transforms_.clear();
    if (Node* const scene = ownScene()) scene->collect(transforms_);
  }
  /// The scene that it is in; outside of scenes, as below a rule, the active one.
  Node* ownScene() const {
    for (Node* up = parent(); up; up = up->parent())
      if (up->classObject()->isA("Scene")) return up;
    auto* const server = kernel().root().find<ISceneServer>();
    return server ? server->activeScene() : nullptr;
  }
  std::vector<Transform*> transforms_;
  TreeWatch tree_;
  Vec3f signs_{1, 1, 1};
};

}  // namespace spark
