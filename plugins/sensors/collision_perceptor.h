#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "api/agents.h"
#include "api/physics.h"

namespace spark {

/// `(collision floor wall)`: names of the colliders that touched since the last percept, or their paths, each once; no
/// percept when there were none. A PerceptorHandler feeds it.
class CollisionPerceptor : public Perceptor {
  SPARK_CLASS(CollisionPerceptor, Perceptor)
 public:
  static void describe(Description<CollisionPerceptor>& d) {
    d.doc("Senses what touched its transform's colliders: (collision names...).");
    d.property("paths", &CollisionPerceptor::paths_)
        .doc("Reports the paths of colliders, which differ also where names are the same; false: their names.");
  }

  /// Records that `collider` touched. Called in the physics phase.
  void touched(const Leaf& collider) {
    if (std::find(ids_.begin(), ids_.end(), collider.id()) != ids_.end()) return;
    if (isRestored(collider)) return;
    ids_.push_back(collider.id());
    names_.add(textOf(collider));
  }

  void sense(Predicates& out, const Event&) override {
    if (names_.empty()) return;
    out.open("collision");
    for (const Element name : names_) out.append(name);
    out.close();
    clear();
  }

 protected:
  /// True when a collider touched since the last clear().
  bool wasTouched() const { return !names_.empty(); }
  void clear() {
    names_.clear();
    ids_.clear();
  }
  /// Saves the names that were not reported yet. Ids are not saved: they belong to one kernel.
  void saveState(StateWriter& out) const override { out.write(Value(toList(names_))); }
  void loadState(StateReader& in) override {
    clear();
    const List names = in.readValue().toList();
    append(names, names_);
    ids_.assign(names.size(), kRestored);
  }

 private:
  std::string textOf(const Leaf& collider) const { return paths_ ? collider.path() : collider.name(); }

  static constexpr std::uint64_t kRestored = 0;  ///< id of a collider of which only the name was restored
  /// True when a restored name is that of `collider`; the entry takes its id then.
  bool isRestored(const Leaf& collider) {
    std::size_t i = 0;
    for (const Element name : names_) {
      if (ids_[i] == kRestored && name.text() == textOf(collider)) {
        ids_[i] = collider.id();
        return true;
      }
      ++i;
    }
    return false;
  }
  bool paths_ = false;
  Predicates names_;                ///< of the colliders that touched, or their paths
  std::vector<std::uint64_t> ids_;  ///< of the same colliders
};

}  // namespace spark
