#pragma once
/// \file
/// The colliders of scene files.

#include "api/robot_parts.h"
#include "collider.h"
#include "shapes.h"

namespace spark {

/// Holds the collider below it, which may have an offset. Contacts are reported for this one.
class TransformCollider : public Collider {
  SPARK_CLASS(TransformCollider, Collider)
 public:
  static void describe(Description<TransformCollider>& d) {
    d.doc(
        "Holds a collider at an offset from its body. Contacts are reported for it, so handlers are its own children.");
  }
};

/// Base of the colliders with shapes that need not be convex. On its own, as in old scenes, it has no geometry.
class ConcaveCollider : public Collider {
  SPARK_CLASS(ConcaveCollider, Collider)
 public:
  static void describe(Description<ConcaveCollider>& d) { d.doc("Base of concave colliders; has no geometry itself."); }
};
/// Accepted for old scenes; has no geometry.
class ConeCollider : public Collider {
  SPARK_CLASS(ConeCollider, Collider)
 public:
  static void describe(Description<ConeCollider>& d) { d.doc("Accepted for old scenes; has no geometry."); }
};
/// Accepted for old scenes; has no geometry.
class CompoundCollider : public Collider {
  SPARK_CLASS(CompoundCollider, Collider)
 public:
  static void describe(Description<CompoundCollider>& d) { d.doc("Accepted for old scenes; has no geometry."); }
};
/// A collider without geometry.
class EmptyCollider : public Collider {
  SPARK_CLASS(EmptyCollider, Collider)
 public:
  static void describe(Description<EmptyCollider>& d) { d.doc("Touches nothing."); }
};

/// A box; each edge is 1 m long by default.
class BoxCollider : public Collider, public IRobotBox {
  SPARK_CLASS(BoxCollider, Collider)
 public:
  static void describe(Description<BoxCollider>& d);
  std::vector<SceneCall> sceneCalls() const override;
  std::optional<engine::ShapeDescription> shape() const override;
  std::optional<Vec3> halfExtent(const Mat3& rotation) const override {
    return Vec3(rotation.cwiseAbs() * (lengths_ / 2));
  }

  Leaf& leaf() override { return *this; }
  Pose pose() const override { return geomPose(); }
  Vec3 boxLengths() const override { return lengths_; }
  bool ignores(const std::string& collider) const override;
  const std::vector<std::string>& freezeJointEffectors() const override { return freezes_; }

 private:
  void setLengths(const Vec3& v) { change(lengths_, v); }
  double length(int axis) const;
  void addFreezeJointEffector(std::string name) { freezes_.push_back(std::move(name)); }
  Vec3 lengths_{1, 1, 1};  ///< full edges [m]
  std::vector<std::string> freezes_;
};

/// A sphere; its radius is 1 m by default.
class SphereCollider : public Collider {
  SPARK_CLASS(SphereCollider, Collider)
 public:
  static void describe(Description<SphereCollider>& d);
  std::optional<engine::ShapeDescription> shape() const override;
  std::optional<Vec3> halfExtent(const Mat3&) const override { return Vec3(Vec3::Constant(radius_)); }

 private:
  double radius() const { return radius_; }
  void setRadius(double r) { change(radius_, r); }
  double radius_ = 1;  ///< m
};

/// Base of capsule and cylinder: a radius and a length along z, 1 m each by default.
template <class Self, engine::Shape S>
class LongCollider : public Collider {
 public:
  std::optional<engine::ShapeDescription> shape() const override {
    engine::ShapeDescription s;
    s.shape = S;
    s.radius = radius();
    s.length = length();
    return s;
  }
  std::optional<Vec3> halfExtent(const Mat3& rotation) const override {
    const Vec3 z = rotation.col(2).cwiseAbs();
    if constexpr (S == engine::Shape::capsule)
      return Vec3(z * (length() / 2) + Vec3::Constant(radius()));
    else  // A disk with the unit normal z reaches radius * sqrt(1 - z_i^2) along axis i.
      return Vec3(z * (length() / 2) + radius() * (Vec3::Ones() - z.cwiseProduct(z)).cwiseMax(0).cwiseSqrt());
  }

 protected:
  static void describeLong(Description<Self>& d) {
    d.property("radius", &Self::radius, &Self::setRadius).unit("m").range(0, physics::kFarthest).doc("Radius.");
    d.property("length", &Self::length, &Self::setLength)
        .unit("m")
        .range(0, physics::kFarthest)
        .doc("Length along z, without caps.");
    d.method("setParams", &Self::setParams).parameters({"radius [m]", "length [m]"}).doc("Radius and length at once.");
    d.method("getPointDepth", &Self::pointDepth)
        .parameters({"point [m]"})
        .doc("Depth of a point, given in the frame of its transform, below the surface [m]; negative outside.");
  }
  double radius() const { return size_[0]; }
  double length() const { return size_[1]; }
  void setRadius(double r) { setParams(r, length()); }
  void setLength(double l) { setParams(radius(), l); }
  void setParams(double r, double l) { change(size_, {r, l}); }

 private:
  std::array<double, 2> size_{1, 1};  ///< radius and length [m]
};

/// A cylinder with a half sphere at each end.
class CapsuleCollider : public LongCollider<CapsuleCollider, engine::Shape::capsule> {
  SPARK_CLASS(CapsuleCollider, Collider)
 public:
  static void describe(Description<CapsuleCollider>& d) {
    d.doc("A capsule along z.");
    describeLong(d);
  }
};

/// A cylinder.
class CylinderCollider : public LongCollider<CylinderCollider, engine::Shape::cylinder> {
  SPARK_CLASS(CylinderCollider, Collider)
 public:
  static void describe(Description<CylinderCollider>& d) {
    d.doc("A cylinder along z.");
    describeLong(d);
  }
};

/// An infinite plane in the world; transforms above do not move it.
class PlaneCollider : public Collider {
  SPARK_CLASS(PlaneCollider, Collider)
 public:
  static void describe(Description<PlaneCollider>& d);
  std::vector<SceneCall> sceneCalls() const override;
  std::optional<engine::ShapeDescription> shape() const override;

 private:
  void setParams(std::vector<double> numbers);
  double pointDepth(const Vec3& p) const;
  std::array<double, 4> plane_{0, 0, 1, 0};  ///< a b c d of ax + by + cz = d; the normal may have any length above 0
};

/// A probe: its contacts call handlers and are never solid.
class RayCollider : public Collider {
  SPARK_CLASS(RayCollider, Collider)
 public:
  static void describe(Description<RayCollider>& d);
  std::vector<SceneCall> sceneCalls() const override;
  std::optional<engine::ShapeDescription> shape() const override;

 private:
  void setParams(const Vec3& origin, const Vec3& direction, double length);
  engine::ShapeDescription ray_{.shape = engine::Shape::ray};
};

}  // namespace spark
