#pragma once
/// \file
/// Makes nodes of an MJCF model.

#include "api/physics.h"
#include "model.h"
#include "spark/kernel.h"

namespace spark::mjcf {

/// Makes the nodes of one model: bodies side by side below a Space, with their joints, colliders and shapes, and with
/// the robot's perceptors and effectors.
///
/// A body without joints becomes part of its parent. Poses, anchors and axes are set in double precision.
class Builder {
 public:
  /// `prefix` stands before all names, except those of perceptors and effectors.
  /// `strict`: what is left out is an error.
  Builder(const Model& model, std::string prefix, bool strict, LeftOver& leftOver)
      : model_(model), prefix_(std::move(prefix)), strict_(strict), leftOver_(leftOver) {}
  /// Builds below `root`. Throws Error with file:line:column; the tree is then as before.
  void build(Node& root);
  /// After build(): sensors and actuators have no perceptors and effectors, because those classes are not there.
  bool withoutParts() const { return withoutParts_; }

 private:
  /// A body of the file that has joints, with what is part of it.
  struct Part {
    const Body* body = nullptr;
    int carrier = 0;                                   ///< index of the body whose part it is; 0: the world
    Pose inCarrier;                                    ///< of the body's frame
    Pose world;                                        ///< of the body's frame, when built
    engine::Mass mass{0, Vec3::Zero(), Mat3::Zero()};  ///< of a carrier: all of it, centre in its frame
    Node* node = nullptr;                              ///< of a carrier: its transform
    int above = 0;                                     ///< of a carrier: the carrier that its joints connect it to
    std::vector<Node*> colliders;                      ///< of the body's own geoms
  };
  struct MadeJoint {
    const Joint* joint;
    IJoint* made;
  };

  void placeBodies(const Pose& root);
  void makeBody(Part& part);
  void makeJoints(Part& part);
  void makeJoint(Part& part, const Joint& joint, Node& child, const std::string& parentPath);
  void makeGeoms(Part& part);
  void makeCollider(const Geom& geom, Part& part, const Pose& pose);
  void makeVisible(const Geom& geom, Node& parent, const Pose& pose);
  void makeSites(const Part& part);
  void exclude();
  void pair();
  bool inPair(const std::string& geom) const;
  void makeActuators();
  void makeActuator(const std::vector<const Actuator*>& all, const MadeJoint& joint);
  void makeSensors();
  void setOptions(Node& root);
  Node& transform(Node& parent, const std::string& name, const Pose& local);
  Node& frame(const Sensor& sensor);
  Part* partOf(const std::string& body, const Element& user);
  /// True when there is such a class of perceptors or effectors.
  bool has(const char* className);
  std::string nameOf(const std::string& given, const char* kind);
  std::string uniqueName(std::set<std::string>& taken, const std::string& given, const char* kind);

  const Model& model_;
  std::string prefix_;
  bool strict_;
  LeftOver& leftOver_;
  Node* top_ = nullptr;
  Pose rootPose_;
  std::vector<Part> parts_;  ///< by body
  std::map<std::string, MadeJoint, std::less<>> joints_;
  std::map<std::string, Node*, std::less<>> sites_, geoms_;  ///< geoms: their colliders
  std::map<std::string, Part*, std::less<>> bodies_;
  std::set<std::string> bodyNames_, colliderNames_;
  std::set<std::string, std::less<>> freeJoints_;
  int unnamed_ = 0;
  bool withoutParts_ = false;
};

}  // namespace spark::mjcf
