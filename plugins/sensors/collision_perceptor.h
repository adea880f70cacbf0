#pragma once

#include "api/agents.h"
#include "api/physics.h"

namespace spark {

/// `(collision floor Ball)`: names of the colliders that touched since it last sensed; says nothing when there were none. A PerceptorHandler
/// feeds it.
class CollisionPerceptor : public Perceptor {
  SPARK_CLASS(CollisionPerceptor, Perceptor)
 public:
  static void describe(Description<CollisionPerceptor>& d) { d.doc("Senses what touched its transform's colliders: (collision names...)."); }

  /// The physics phase: this collider touched. The points of one collider come in a row.
  void touched(const Leaf& collider) {
    if (collider.id() == last_) return;
    last_ = collider.id();
    names_.add(collider.name());
  }

  void sense(Predicates& out, const Event&) override {
    if (names_.empty()) return;
    out.open("collision");
    for (const Element name : names_) out.append(name);
    out.close();
    forget();
  }

 protected:
  bool wasTouched() const { return !names_.empty(); }
  void forget() {
    names_.clear();
    last_ = 0;
  }

 private:
  Predicates names_;
  std::uint64_t last_ = 0;
};

}  // namespace spark
