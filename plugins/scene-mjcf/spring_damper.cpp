#include "spring_damper.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

namespace spark::mjcf {

namespace {

/// A degree of freedom, world frame.
struct Dof {
  Vec3 axis;
  Vec3 anchor;  ///< of a rotation
  bool rotates;
  double armature;
  Joint* joint;  ///< of a hinge or slider; nullptr: of another one
};

/// The bodies and degrees of freedom of one tree.
class Tree {
 public:
  /// Adds a body; `above`: last() of its parent, -1 for none.
  void add(Body& body, const Pose& world, int above);
  /// The last degree of freedom that moves the body that was added last.
  int last() const { return last_; }
  std::size_t size() const { return dofs_.size(); }
  void setSpringDampers();

 private:
  void addDof(const Dof& dof);
  Eigen::MatrixXd inertia() const;

  struct Part {
    double mass;
    Vec3 center;
    Mat3 inertia;
    int last;
  };
  std::vector<Dof> dofs_;
  std::vector<int> above_;  ///< by degree of freedom: the next one above
  std::vector<Part> parts_;
  int last_ = -1;
};

void Tree::addDof(const Dof& dof) {
  above_.push_back(last_);
  last_ = static_cast<int>(dofs_.size());
  dofs_.push_back(dof);
}

void Tree::add(Body& b, const Pose& world, int above) {
  last_ = above;
  for (Joint& j : b.joints) {
    const Vec3 anchor = world.position + world.rotation * j.position, axis = world.rotation * j.axis;
    if (j.kind == JointKind::hinge || j.kind == JointKind::slide)
      addDof({axis, anchor, j.kind == JointKind::hinge, j.armature, &j});
    if (j.kind == JointKind::free)
      for (int i = 0; i < 3; ++i) addDof({Vec3::Unit(i), anchor, false, 0, nullptr});
    if (j.kind == JointKind::free || j.kind == JointKind::ball)
      for (int i = 0; i < 3; ++i) addDof({world.rotation.col(i), anchor, true, 0, nullptr});
  }
  if (b.mass.mass > 0)
    parts_.push_back({b.mass.mass, world.position + world.rotation * b.mass.center,
                      world.rotation * b.mass.inertia * world.rotation.transpose(), last_});
}

Eigen::MatrixXd Tree::inertia() const {
  const auto n = static_cast<Eigen::Index>(dofs_.size());
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) m(i, i) = dofs_[std::size_t(i)].armature;
  const auto speed = [](const Dof& d, const Vec3& at) {
    return d.rotates ? Vec3(d.axis.cross(at - d.anchor)) : d.axis;
  };
  for (const Part& p : parts_)
    for (int i = p.last; i >= 0; i = above_[std::size_t(i)])
      for (int k = i; k >= 0; k = above_[std::size_t(k)]) {
        const Dof &a = dofs_[std::size_t(i)], &b = dofs_[std::size_t(k)];
        double v = p.mass * speed(a, p.center).dot(speed(b, p.center));
        if (a.rotates && b.rotates) v += a.axis.dot(p.inertia * b.axis);
        m(i, k) += v;
        if (i != k) m(k, i) += v;
      }
  return m;
}

void Tree::setSpringDampers() {
  const Eigen::LDLT<Eigen::MatrixXd> solver(inertia());
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    Joint* const j = dofs_[i].joint;
    if (!j || !j->springDamper) continue;
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(dofs_.size()), Eigen::Index(i));
    const double felt = 1 / solver.solve(unit)[Eigen::Index(i)], time = (*j->springDamper)[0],
                 ratio = (*j->springDamper)[1];
    if (!std::isfinite(felt) || felt < 0) continue;
    j->damping = 2 * felt / time;
    j->stiffness = felt / (time * time * ratio * ratio);
  }
}

}  // namespace

void setSpringDampers(Model& model, Unsupported& unsupported) {
  const auto has = [](const Joint& j) { return j.springDamper.has_value(); };
  if (std::none_of(model.bodies.begin(), model.bodies.end(),
                   [&](const Body& b) { return std::any_of(b.joints.begin(), b.joints.end(), has); }))
    return;
  std::vector<Pose> world(model.bodies.size());
  std::vector<int> last(model.bodies.size(), -1);
  std::vector<std::size_t> treeOf(model.bodies.size(), 0);
  std::vector<Tree> trees;
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    Body& b = model.bodies[i];
    const auto parent = static_cast<std::size_t>(b.parent);
    world[i] = compose(world[parent], b.pose);
    if (parent == 0) trees.emplace_back();
    treeOf[i] = parent == 0 ? trees.size() - 1 : treeOf[parent];
    Tree& tree = trees[treeOf[i]];
    tree.add(b, world[i], last[parent]);
    last[i] = tree.last();
  }
  for (Tree& tree : trees)
    if (tree.size() <= kMaxCoordinates) tree.setSpringDampers();
  for (std::size_t i = 1; i < model.bodies.size(); ++i)
    for (const Joint& j : model.bodies[i].joints)
      if (has(j) && trees[treeOf[i]].size() > kMaxCoordinates)
        unsupported.add(j.from, fmt::format("the attribute 'springdamper' in a tree of more than {} coordinates is not "
                                            "supported",
                                            kMaxCoordinates));
}

}  // namespace spark::mjcf
