#pragma once
/// \file
/// Passes the scene nodes of a subtree to a remote host: where they are, and what they look and collide like; and the
/// properties that the host reads.

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "api/phases.h"
#include "api/scene.h"
#include "spark/kernel.h"
#include "spark/value.h"

namespace spark::remote {

class Wire;

/// True for transforms, and for a class whose objects look or collide like something and do nothing else: a host that
/// mounts a tree can have them in its own scene. Planes and rays are none: they reach through all of a scene.
bool isOfScene(ClassObject& c);

/// What one client knows of scene nodes and properties. Simulation thread.
class SceneFeed {
 public:
  /// The client wants scene nodes.
  void wantScene() { wanted_ = true; }
  bool wanted() const { return wanted_; }
  /// What makes a new node of the class of `leaf` what it is: {pose, calls, properties}; nil if it is no scene node.
  /// The client gets it.
  Value describe(Leaf& leaf);
  /// The client reads a property, and gets its values from now on; false: it has too many.
  bool follow(Leaf& leaf, const std::string& property, const Value& value);
  /// The client has changed a node: the next message has it.
  void touch(const Leaf& leaf) {
    if (wanted_) touched_.insert(leaf.id());
  }
  /// The client has handled message `n`.
  void handled(std::uint64_t n) { handled_ = n; }

  /// Sends what has changed below `root` since the last call. `now`: in any case; false: only after the client has
  /// handled what was sent before, and once in each of the simulation's cycles also without a change.
  void update(Node& root, bool now, const ISimulation* simulation, Wire& out);

 private:
  struct Known {
    Matrix pose = Matrix::Identity();
    std::string look;  ///< calls and properties, encoded
    std::uint64_t round = 0;
  };
  struct Entry {
    Leaf* leaf;
    Transform* transform;  ///< nullptr: it has calls and properties
    Known* known;
  };
  struct Followed {
    Ref<Leaf> leaf;
    std::uint64_t id;             ///< of the leaf
    std::string property, value;  ///< the value encoded
  };
  void collect(Node& root);
  bool isOfScene(const Leaf& leaf);
  List poses();
  List looks(std::size_t count);
  void compare(Entry& entry, List& changed, std::size_t& bytes);
  List values();

  bool wanted_ = false;
  std::map<std::uint64_t, Known> known_;   ///< by Leaf::id
  std::vector<Entry> places_, looks_;      ///< transforms, and all others
  std::size_t next_ = 0;                   ///< of looks_, to be compared
  std::map<std::uint64_t, bool> classes_;  ///< whether they are of scenes, by Leaf::id of the class
  std::set<std::uint64_t> touched_;        ///< ids
  std::vector<Followed> followed_;
  std::set<std::pair<std::uint64_t, std::string>> isFollowed_;
  std::uint64_t root_ = 0, version_ = 0, round_ = 0, modified_ = 0;
  std::uint64_t sent_ = 0, handled_ = 0;  ///< numbers of the last messages
  std::int64_t cycle_ = -1;               ///< of the last message
};

}  // namespace spark::remote
