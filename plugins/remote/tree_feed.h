#pragma once
/// \file
/// Tells a remote host what a subtree looks like, and what has changed since the last time.

#include <cstdint>
#include <map>
#include <string>

#include "spark/kernel.h"
#include "spark/value.h"

namespace spark::remote {

class SceneFeed;
class Wire;

/// The subtree as one client knows it. Of the whole tree, /classes, /plugins and /sys/host are left out: what the
/// program shows of a run.
class TreeFeed {
 public:
  /// Sends the changes below `root` since the last call; all of it at first. Costs one comparison if there are none.
  /// `scene` says what new scene nodes are.
  void update(Node& root, SceneFeed& scene, Wire& out);

 private:
  struct Known {
    std::uint64_t parent = 0, round = 0;
    std::string name;
  };
  void visit(Node& node, SceneFeed& scene, Wire& out);
  void tell(Leaf& leaf, SceneFeed& scene, Wire& out);
  void tellClass(ClassObject& c, Wire& out);

  std::map<std::uint64_t, Known> known_;          ///< by Leaf::id
  std::map<std::string, std::uint64_t> classes_;  ///< name, and id of the class object that was described
  std::uint64_t root_ = 0, version_ = 0, round_ = 0;
};

}  // namespace spark::remote
