#pragma once
/// \file
/// Scene nodes of a field: ball, flags, goal posts, lines, and the nodes that make them visible to agents.

#include <string>

#include "api/appearance.h"
#include "api/match.h"
#include "api/scene.h"

namespace spark {

/// The ball. Its node is `Ball` below the active scene and holds a body and a collider with a recorder.
class Ball : public Transform {
  SPARK_CLASS(Ball, Transform)
 public:
  static void describe(Description<Ball>& d) {
    d.doc("The ball: /usr/scene/Ball with children physics and geometry/recorder.");
  }
};

/// A flag without a body.
class FieldFlag : public Transform {
  SPARK_CLASS(FieldFlag, Transform)
 public:
  static void describe(Description<FieldFlag>& d) { d.doc("A flag that marks a point of the field."); }
};

/// Base of the nodes that soccer attaches to a transform.
class SoccerNode : public SceneNode {
  SPARK_CLASS(SoccerNode, SceneNode)
 public:
  static void describe(Description<SoccerNode>& d) {
    d.doc("Base of the nodes that soccer attaches to a transform.");
    d.abstract();
  }
};

/// Makes the transform above it visible to agents.
class ObjectState : public SoccerNode {
  SPARK_CLASS(ObjectState, SoccerNode)
 public:
  static void describe(Description<ObjectState>& d) {
    d.doc("Makes the transform above it visible to agents.");
    d.property("perceptName", &ObjectState::perceptName_)
        .doc("Its label in See: B, F1L, ...; \"\" for parts of robots.");
    d.property("ID", &ObjectState::id_).doc("Name of the part of a robot that it marks: head, lfoot, ...");
  }
  /// Label of the object in See: B, F1L, ...; "" for parts of robots.
  const std::string& perceptName() const { return perceptName_; }
  /// Name of the robot part that it marks; "" for others.
  const std::string& id() const { return id_; }

 protected:
  std::string perceptName_, id_;
};

/// A goal post: a visible object that sonars detect, too.
class GoalPost : public ObjectState, public IEchoTarget {
  SPARK_CLASS(GoalPost, ObjectState)
 public:
  static void describe(Description<GoalPost>& d) {
    d.doc("A goal post: visible, and seen by sonars.");
    d.implements<IEchoTarget>();
  }
};

/// A straight line on the field.
class Line : public SoccerNode, public IPaintedLine {
  SPARK_CLASS(Line, SoccerNode)
 public:
  static void describe(Description<Line>& d) {
    d.doc("A straight line on the field, seen by cone vision.");
    d.implements<IPaintedLine>();
    d.property("beginPoint", &Line::begin_).unit("m").doc("One end, in the frame of the transform above.");
    d.property("endPoint", &Line::end_).unit("m").doc("The other end.");
  }
  /// One end, in the frame of the transform above [m].
  const Vec3f& begin() const { return begin_; }
  /// The other end, in the frame of the transform above [m].
  const Vec3f& end() const { return end_; }
  Leaf& leaf() override { return *this; }
  std::array<Vec3f, 2> ends() const override { return {begin_, end_}; }
  float width() const override { return 0.05f; }

 private:
  Vec3f begin_ = Vec3f::Zero(), end_ = Vec3f::Zero();
};

}  // namespace spark
