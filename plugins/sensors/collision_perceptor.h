#pragma once

#include <algorithm>
#include <vector>

#include "api/agents.h"
#include "api/physics.h"

namespace spark {

/// `(collision floor wall)`: names of the colliders that touched since it last sensed, each once; says nothing when
/// there were none. A PerceptorHandler feeds it.
class CollisionPerceptor : public Perceptor {
  SPARK_CLASS(CollisionPerceptor, Perceptor)
 public:
  static void describe(Description<CollisionPerceptor>& d) {
    d.doc("Senses what touched its transform's colliders: (collision names...).");
  }

  /// The physics phase: this collider touched.
  void touched(const Leaf& collider) {
    if (std::find(ids_.begin(), ids_.end(), collider.id()) != ids_.end()) return;
    if (isRestored(collider)) return;
    ids_.push_back(collider.id());
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
    ids_.clear();
  }
  /// What it has not reported yet, by name: ids belong to one kernel.
  void saveState(StateWriter& out) const override { out.write(Value(toList(names_))); }
  void loadState(StateReader& in) override {
    forget();
    const List names = in.readValue().toList();
    append(names, names_);
    ids_.assign(names.size(), kRestored);
  }

 private:
  static constexpr std::uint64_t kRestored = 0;  ///< id of a collider of which only the name is known
  /// True when a restored name is this collider's, which has its id from now on.
  bool isRestored(const Leaf& collider) {
    std::size_t i = 0;
    for (const Element name : names_) {
      if (ids_[i] == kRestored && name.text() == collider.name()) {
        ids_[i] = collider.id();
        return true;
      }
      ++i;
    }
    return false;
  }
  Predicates names_;
  std::vector<std::uint64_t> ids_;
};

}  // namespace spark
