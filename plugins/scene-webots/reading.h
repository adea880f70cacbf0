#pragma once
/// \file
/// What the readers of one Webots file share.

#include <set>

#include "document.h"
#include "fields.h"
#include "robot/model.h"

namespace spark::webots {

/// A frame in which nodes stand: that of a body, a pose in it, and by how much lengths grow.
struct Frame {
  std::size_t body = 0;  ///< index in the model
  Pose pose{};
  Vec3 scale = Vec3::Ones();
  /// The pose in the body of what is placed by `local`.
  Pose at(const Pose& local) const { return compose(pose, {scale.cwiseProduct(local.position), local.rotation}); }
  bool isUniform() const { return scale.x() == scale.y() && scale.y() == scale.z(); }
};

/// Names that differ: one that is taken gets ~2, ~3, ... at its end.
class UniqueNames {
 public:
  std::string add(const std::string& name);

 private:
  std::set<std::string, std::less<>> taken_;
  std::map<std::string, int, std::less<>> last_;  ///< number that a name has had
};

/// State of one run over a file.
struct Reading {
  const Document& document;
  mjcf::Unsupported& unsupported;
  std::size_t visited = 0;  ///< nodes, those that USE names as often as they are used

  /// Throws Error when a file has grown absurdly large by USE and PROTOs.
  void visit(const Node& node) {
    if (++visited > mjcf::kMaxElements)
      throw node.element().error(
          fmt::format("expected at most {} nodes, used ones counted each time", mjcf::kMaxElements));
  }
  /// A node of a type that is no base node: its PROTO is not there.
  Error missing(const Node& node) const;
  void ignore(const Node& node, const std::string& why) { unsupported.add(node.element(), why); }
};

/// The frame of a Group, Pose or Transform, and of a Solid, in the one around. Throws Error.
Frame frameIn(const Frame& around, Fields& fields);

}  // namespace spark::webots
