#pragma once
/// \file
/// What the readers of one Webots file share.

#include <fmt/format.h>

#include <set>

#include "contact_materials.h"
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
  Pose at(const Pose& local) const { return compose(pose, scaled(local)); }
  /// A pose in this frame as it is where nothing is scaled: a mirror turns rotations.
  Pose scaled(const Pose& local) const {
    const Mat3 mirror = scale.cwiseSign().asDiagonal();
    return {scale.cwiseProduct(local.position), mirror * local.rotation * mirror};
  }
  /// True where all directions are scaled by the same number; some may be mirrored.
  bool isUniform() const {
    const Vec3 lengths = scale.cwiseAbs();
    return lengths.x() == lengths.y() && lengths.y() == lengths.z();
  }
};

/// Names that differ: one that is taken gets ~2, ~3, ... at its end.
class UniqueNames {
 public:
  std::string add(const std::string& name);

 private:
  std::set<std::string, std::less<>> taken_;
  std::map<std::string, int, std::less<>> last_;  ///< number that a name has had
};

using mjcf::LimitError;

/// State of one run over a file.
struct Reading {
  const Document& document;
  mjcf::Unsupported& unsupported;
  ContactMaterials materials{};
  std::size_t visited = 0;  ///< nodes, those that USE names as often as they are used

  /// Throws Error when a file has grown absurdly large by USE and PROTOs.
  void visit(const Node& node) {
    if (++visited > mjcf::kMaxElements)
      throw LimitError(fmt::format("{}: expected at most {} nodes, used ones counted each time", node.element().where(),
                                   mjcf::kMaxElements));
  }
  /// Names a node that cannot be at its place, or whose PROTO is not there.
  void missing(const Node& node);
  void ignore(const Node& node, const std::string& why) { unsupported.add(node.element(), why); }
  /// Does `work`. A part of the node that fails is left out, and named. Throws LimitError.
  template <class Work>
  void leaveOut(const Node& node, const char* part, Work work) {
    try {
      work();
    } catch (const LimitError&) {
      throw;
    } catch (const Error& error) {
      std::string text = error.what();
      if (text.starts_with(node.file->name + ":")) text.erase(0, text.find(": ") + 2);  // the place is that of the node
      ignore(node, fmt::format("{} is left out: {}", part, text));
    }
  }
};

/// The frame of a Group, Pose or Transform, and of a Solid, in the one around. Throws Error.
Frame frameIn(const Frame& around, Fields& fields);

/// The frame of a geometry that stands along z, in the frame of its node: in old files it stands along y.
Frame standing(const Node& geometry, const Frame& frame);

}  // namespace spark::webots
