#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>

#include "api/scene_joint.h"
#include "mjcf_constraints.h"

namespace spark::mujoco {

using engine::Geom;
using engine::Joint;
using engine::JointType;
using engine::Model;
using engine::Shape;

namespace {

/// What a ball or a free body has beside its coordinates.
std::optional<FreedomNumbers> freedomOf(const Model& model, std::uint64_t id) {
  for (const auto& [number, n] : model.extensions.world.all<FreedomNumbers>(kConstraintNumbers))
    if (n.of == id && id != 0) return n;
  return std::nullopt;
}

Pose poseOf(const engine::State& state, Index body) {
  if (body == kNone) return {};
  return {state.bodies[body].position, state.bodies[body].rotation};
}

}  // namespace

Trees::Trees(const Model& model, const engine::State& state) {
  for (const engine::TreeLink& from : engine::JointTrees(model).links) {
    Link& link = links.emplace_back(Link{from, kNone, {}});
    const Joint* const j = link.joint == kNone ? nullptr : &model.joints[link.joint];
    if (j && j->type != JointType::ball) continue;
    const Pose above = link.parent == kNone ? Pose{} : poseOf(state, links[link.parent].body);
    link.zero = compose(inverse(above), poseOf(state, link.body));
    if (!j) continue;
    Mat3 r = compose(inverse(poseOf(state, j->a)), poseOf(state, j->b)).rotation;
    if (const auto n = freedomOf(model, j->id)) {
      // Its coordinates are 0 where it says.
      const auto& q = n->restRotation;
      const Mat3 rest = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
      r = link.childIsA ? Mat3(rest.transpose()) : rest;
    }
    const Pose b{j->inA.anchor - r * j->inB.anchor, r};
    link.zero = link.childIsA ? inverse(b) : b;
  }
  mergeConnectors(model);
}

/// A connector with one child that has its centre of mass, without geoms, on a joint with one axis: a body of MuJoCo
/// may have several of those.
void Trees::mergeConnectors(const Model& model) {
  const auto isMergeable = [&](const Link& link) {
    if (link.joint == kNone || !model.bodies[link.body].connector) return false;
    const JointType type = model.joints[link.joint].type;
    return (type == JointType::hinge || type == JointType::slider) &&
           std::none_of(model.geoms.begin(), model.geoms.end(), [&](const Geom& g) { return g.body == link.body; });
  };
  std::vector<int> children(links.size(), 0);
  std::vector<Index> child(links.size(), kNone);
  for (Index i = 0; i < links.size(); ++i)
    if (links[i].parent != kNone) ++children[links[i].parent], child[links[i].parent] = i;
  for (Index i = static_cast<Index>(links.size()); i-- > 0;) {
    Link& link = links[i];
    if (children[i] != 1 || links[child[i]].joint == kNone || !isMergeable(link)) continue;
    const Link& next = links[child[i]];
    if (next.zero.position.norm() > 1e-9) continue;
    link.carrier = next.carrier == kNone ? child[i] : next.carrier;
    link.carrierInLink = next.carrier == kNone ? next.zero : compose(next.zero, next.carrierInLink);
  }
}

std::string bodyName(Index body) { return fmt::format("b{}", body); }
std::string partName(Index body, std::size_t part) { return fmt::format("b{}p{}", body, part); }
std::string geomName(Index geom) { return fmt::format("g{}", geom); }
std::string freeJointName(Index body) { return fmt::format("f{}", body); }
std::string pieceName(Index geom, std::size_t piece) { return fmt::format("g{}p{}", geom, piece); }
std::string jointName(Index joint, int coordinate) { return fmt::format("j{}_{}", joint, coordinate); }

int coordinatesOf(JointType type) {
  switch (type) {
    case JointType::hinge:
    case JointType::slider:
    case JointType::ball:
      return 1;
    case JointType::universal:
      return 2;
    case JointType::hinge2:
      return 3;
    default:
      return 0;
  }
}

namespace {

/// Principal moments of inertia, and their axes. `wanted` are taken if they are principal: of equal moments any axes
/// are, and drag depends on which.
std::pair<Vec3, Mat3> principalAxes(const Mat3& inertia, const Mat3& wanted) {
  if (const Mat3 turned = wanted.transpose() * inertia * wanted; turned.isDiagonal(1e-14))
    return {turned.diagonal(), wanted};
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return {solver.eigenvalues(), axes};
}

/// MuJoCo's compiler refuses the world of a moving body whose mass or moments are below 1e-15 (mjMINVAL).
constexpr double kLeastMass = 2e-15;  // kg, and of moments kg m^2

/// A mass with its principal moments of inertia.
struct Inertial {
  double mass = 0;             // kg
  Vec3 center = Vec3::Zero();  // m
  Vec3 moments = Vec3::Zero();
  Mat3 axes = Mat3::Identity();

  explicit Inertial(const engine::Part& p) : mass(p.mass), center(p.center) {
    // MuJoCo's own decomposition of an inertia leaves an error of 1e-6. Rounding may leave moments below 0.
    std::tie(moments, axes) = principalAxes(p.inertia, p.axes);
    moments = moments.cwiseMax(0);
  }
  double least() const { return std::min(mass, moments.minCoeff()); }
  void raise() {
    mass = std::max(mass, kLeastMass);
    moments = moments.cwiseMax(kLeastMass);
  }
};

/// Writes the elements of a world.
struct Writer {
  const Model& model;
  const Trees& trees;
  const Constraints& constraints;
  const MeshPieces& pieces;
  double step;  // s
  std::string out;
  std::vector<std::vector<Index>> children, geoms;                            // by link; by body
  std::unordered_map<const engine::Mesh*, Index> meshOf = {}, piecesIn = {};  // the geom whose name it has
  std::vector<std::uint64_t> raised = {};                                     // as in Written

  template <class... A>
  void put(fmt::format_string<A...> format, A&&... arguments) {
    fmt::format_to(std::back_inserter(out), format, std::forward<A>(arguments)...);
  }
  static std::string text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
  void putPose(const Pose& p) {
    const Eigen::Quaterniond q(p.rotation);
    put(R"( pos="{}" quat="{} {} {} {}")", text(p.position), q.w(), q.x(), q.y(), q.z());
  }

  /// The mesh that MuJoCo makes a hull of.
  const engine::Mesh* meshFor(Index index) const {
    const auto own = model.extensions.geoms[index].get<MeshNumbers>();
    const engine::ShapeDescription& s = model.geoms[index].shape;
    if (s.shape == Shape::mesh) return pieces.of(model.geoms[index]).written.get();
    return s.shape == Shape::convex && own.mesh ? own.mesh : s.mesh.get();
  }
  /// The pieces of a geom that is a static mesh; empty: it is none, or has its hull.
  std::span<const Piece> piecesFor(Index index) const {
    const Geom& g = model.geoms[index];
    if (g.shape.shape != Shape::mesh || g.body != kNone) return {};
    return pieces.of(g).pieces;
  }
  /// True if a mesh has neither pieces nor a hull.
  bool isNothing(Index index) const {
    const Geom& g = model.geoms[index];
    return g.shape.shape == Shape::mesh && piecesFor(index).empty() && !pieces.of(g).isSolid;
  }

  void putGeom(Index index) {
    const std::size_t count = piecesFor(index).size();
    if (count == 0) return putGeom(index, geomName(index), "");
    for (std::size_t k = 0; k < count; ++k)
      putGeom(index, pieceName(index, k), fmt::format("m{}p{}", piecesIn.at(meshFor(index)), k));
  }
  /// `mesh`: the name of that of a piece.
  void putGeom(Index index, const std::string& name, const std::string& mesh) {
    const Geom& g = model.geoms[index];
    const engine::ShapeDescription& s = g.shape;
    if (s.shape == Shape::ray || isNothing(index)) return;
    put(R"(<geom name="{}" contype="{}" conaffinity="{}")", name, g.collides ? 1 : 0, g.collides ? 1 : 0);
    // No shape of MuJoCo's may be without extent.
    const auto length = [](double v) { return std::max(v, 1e-6); };
    Pose pose = g.offset;
    const auto m = model.extensions.geoms[index].get<SurfaceNumbers>();
    switch (s.shape) {
      case Shape::box:
        put(R"( type="box" size="{} {} {}")", length(s.lengths.x() / 2), length(s.lengths.y() / 2),
            length(s.lengths.z() / 2));
        break;
      case Shape::sphere:
        put(R"( type="sphere" size="{}")", length(s.radius));
        break;
      case Shape::capsule:
      case Shape::cylinder:
        put(R"( type="{}" size="{} {}")", s.shape == Shape::capsule ? "capsule" : "cylinder", length(s.radius),
            length(s.length / 2));
        break;
      case Shape::plane: {
        const Vec3 normal(s.plane[0], s.plane[1], s.plane[2]);
        pose.rotation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
        pose.position = normal * (s.plane[3] / normal.squaredNorm());
        put(R"( type="plane" size="0 0 1")");
        break;
      }
      case Shape::heightField:
        put(R"( type="hfield" hfield="{}")", geomName(index));
        pose.position += pose.rotation * Vec3(0, 0, s.heightField->low);
        break;
      default:
        if (s.shape == Shape::convex && m.ellipsoid[0] > 0)
          put(R"( type="ellipsoid" size="{}")", fmt::join(m.ellipsoid, " "));
        else
          put(R"( type="mesh" mesh="{}")", mesh.empty() ? fmt::format("m{}", meshOf.at(meshFor(index))) : mesh);
        break;
    }
    if (g.body != kNone) pose.position -= model.bodies[g.body].linkOrigin;
    putPose(pose);
    put(R"( friction="{}" condim="{}" priority="{}")", fmt::join(m.friction, " "), m.condim, m.priority);
    put(R"( solref="{}" solimp="{}" solmix="{}" margin="{}" gap="{}")", fmt::join(m.solref, " "),
        fmt::join(m.solimp, " "), m.solmix, m.margin, m.gap);
    if (m.ellipsoidDrag != 0) put(R"( fluidshape="ellipsoid" fluidcoef="{}")", fmt::join(m.dragCoefficients, " "));
    put("/>\n");
  }

  void putRange(const engine::JointAxis& a, const AxisNumbers& m) {
    put(R"( solreflimit="{}" solimplimit="{}" margin="{}")", fmt::join(m.stopSolref, " "), fmt::join(m.stopSolimp, " "),
        m.stopMargin);
    if (!(a.lowStop <= a.highStop) || (std::isinf(a.lowStop) && std::isinf(a.highStop))) return;
    // MuJoCo's limits are two-sided; a million turns or metres are as good as none.
    const double low = std::max(a.lowStop, -1e6), high = std::min(a.highStop, 1e6);
    // Equal stops lock the axis: MuJoCo wants a range.
    const double least = low == high ? 1e-6 : 0;
    put(R"( limited="true" range="{} {}")", low - least, high + least);
  }

  /// The spring that acts on a coordinate. Springs count as angles of the model do, coordinates as stops.
  void putSpring(const Joint& j, int axis) {
    const bool reversedUniversal = j.type == JointType::universal && j.reversed;
    const engine::JointAxis& own = j.axes[reversedUniversal ? 1 - axis : axis];
    const bool opposite = reversedUniversal             ? axis == 0
                          : j.type == JointType::hinge2 ? axis == 1
                                                        : j.type == JointType::hinge && j.reversed;
    if (own.stiffness > 0 || own.springPosition != 0)
      put(R"( stiffness="{}" springref="{}")", own.stiffness, (opposite ? -1 : 1) * own.springPosition);
  }

  /// What a ball or a free joint has besides.
  void putFreedom(std::uint64_t id) {
    const auto n = freedomOf(model, id);
    if (!n) return;
    put(R"( armature="{}" frictionloss="{}" stiffness="{}")", n->armature, n->frictionLoss, n->stiffness);
    put(R"( solreffriction="{}" solimpfriction="{}")", fmt::join(n->frictionSolref, " "),
        fmt::join(n->frictionSolimp, " "));
    if (!(n->mostAngle > 0)) return;
    put(R"( limited="true" range="0 {}" margin="{}")", n->mostAngle, n->stopMargin);
    put(R"( solreflimit="{}" solimplimit="{}")", fmt::join(n->stopSolref, " "), fmt::join(n->stopSolimp, " "));
  }

  /// The joint of a link, in the frame of its body. Coordinates are those of the child relative to the parent, which
  /// are the joint's, or their opposites where the child is body b.
  void putJoint(const Link& link) {
    if (link.joint == kNone) {
      put(R"(<joint type="free" name="{}")", freeJointName(link.body));
      putFreedom(model.bodies[link.body].id);
      return put("/>\n");
    }
    const Joint& j = model.joints[link.joint];
    const double sign = link.childIsA ? 1 : -1;
    // In the frame of the body that has the joint.
    const Pose frame = inverse(link.carrierInLink);
    const Index body = link.carrier == kNone ? link.body : trees.links[link.carrier].body;
    const Vec3 anchor = link.childIsA ? j.inA.anchor : j.inB.anchor;
    const Vec3 at = frame.position + frame.rotation * anchor - model.bodies[body].linkOrigin;
    const Mat3 parentInChild = link.zero.rotation.transpose();
    // Axis 1 is fixed in a, axis 2 in b; each in the child's frame, at zero.
    const auto inChild = [&](const Vec3& axis, bool inA) {
      return Vec3(frame.rotation * (sign * (inA == link.childIsA ? axis : Vec3(parentInChild * axis))));
    };
    const auto axial = [&](int coordinate, const char* type, const Vec3& axis, const engine::JointAxis* own,
                           bool limited = true) {
      put(R"(<joint name="{}" type="{}" pos="{}" axis="{}")", jointName(link.joint, coordinate), type, text(at),
          text(axis));
      if (!own) return;
      const auto m = model.extensions.joints[link.joint].get<AxisNumbers>(static_cast<int>(own - j.axes.data()));
      put(R"( armature="{}" damping="{}" solreffriction="{}" solimpfriction="{}")", own->armature, own->damping,
          fmt::join(m.frictionSolref, " "), fmt::join(m.frictionSolimp, " "));
      putSpring(j, static_cast<int>(own - j.axes.data()));
      if (limited) putRange(*own, m);
    };
    switch (j.type) {
      case JointType::hinge:
        axial(0, "hinge", inChild(j.inA.axis[0], true), &j.axes[0]);
        put("/>\n");
        break;
      case JointType::slider:
        axial(0, "slide", (j.reversed ? -1 : 1) * inChild(j.inA.axis[0], true), &j.axes[0]);
        put("/>\n");
        break;
      case JointType::ball:
        put(R"(<joint name="{}" type="ball" pos="{}" damping="{}")", jointName(link.joint, 0), text(at),
            j.axes[0].damping);
        putFreedom(j.id);
        put("/>\n");
        break;
      case JointType::universal:
        // The first joint of a body is the one next to the parent.
        if (link.childIsA) {
          axial(1, "hinge", inChild(j.inB.axis[1], false), &j.axes[1]);
          put("/>\n");
          axial(0, "hinge", inChild(j.inA.axis[0], true), &j.axes[0]);
        } else {
          axial(0, "hinge", inChild(j.inA.axis[0], true), &j.axes[0]);
          put("/>\n");
          axial(1, "hinge", inChild(j.inB.axis[1], false), &j.axes[1]);
        }
        put("/>\n");
        break;
      case JointType::hinge2: {
        // A spring along axis 1, as ODE's ERP and CFM mean one (ODE manual, "Soft constraint and CFM").
        const auto suspension = [&] {
          const auto soft = model.extensions.sceneJoints[link.joint].get<engine::JointSoftness>();
          const double dt = step, erp = soft.suspensionErp, cfm = std::max(soft.suspensionCfm, 1e-7);
          axial(0, "slide", inChild(j.inA.axis[0], true), nullptr);
          put(R"( stiffness="{}" damping="{}"/>)", erp / (cfm * dt), (1 - erp) / cfm);
        };
        const auto steering = [&] {
          axial(1, "hinge", inChild(j.inA.axis[0], true), &j.axes[0]);
          put("/>\n");
        };
        const auto rolling = [&] {
          axial(2, "hinge", inChild(j.inB.axis[1], false), &j.axes[1], false);
          put("/>\n");
        };
        if (link.childIsA)
          rolling(), suspension(), steering();
        else
          suspension(), steering(), rolling();
        break;
      }
      default:
        break;
    }
  }

  /// The parts of a body, at least one. `mass` and `inertia` are of its connectors.
  static std::vector<engine::Part> partsOf(const engine::Body& b, double mass, const Mat3& inertia) {
    double sum = 0;
    Vec3 moment = Vec3::Zero();
    for (const engine::Part& p : b.parts) sum += p.mass, moment += p.mass * p.center;
    if (!(sum > 1e-12)) return {{b.mass + mass, Vec3::Zero(), b.inertia + inertia}};
    std::vector<engine::Part> parts = b.parts;
    // The centre of mass is the body's, whatever the parts say.
    const double share = (b.mass + mass) / sum;
    for (engine::Part& p : parts) p.mass *= share, p.inertia *= share, p.center -= moment / sum;
    return parts;
  }
  /// The same as MuJoCo takes them: one of them must weigh enough.
  std::vector<Inertial> inertialsOf(const engine::Body& b, double mass, const Mat3& inertia) {
    std::vector<Inertial> out;
    for (const engine::Part& p : partsOf(b, mass, inertia)) out.emplace_back(p);
    if (std::any_of(out.begin(), out.end(), [](const Inertial& i) { return i.least() >= kLeastMass; })) return out;
    out.front().raise();
    raised.push_back(b.id);
    return out;
  }
  void putInertial(const engine::Body& b, const Inertial& i) {
    if (i.mass == 0 && (i.center - b.linkOrigin).isZero()) return;
    put(R"(<inertial mass="{}" diaginertia="{}")", i.mass, text(i.moments));
    putPose({i.center - b.linkOrigin, i.axes});
    put("/>\n");
  }
  void putGeoms(Index body, std::size_t part, std::size_t parts) {
    for (const Index g : geoms[body])
      if (const auto own = static_cast<std::size_t>(model.geoms[g].part); (own < parts ? own : 0) == part) putGeom(g);
  }

  /// A link with its body, with the joints of the connectors before it, and all links below.
  void putLink(std::size_t index) {
    Pose zero;
    double mass = 0;  // of the connectors
    Mat3 inertia = Mat3::Zero();
    const Index parent = trees.links[index].parent;
    std::vector<std::size_t> chain;
    for (;; index = children[index].front()) {
      const Link& before = trees.links[index];
      zero = compose(zero, before.zero);
      chain.push_back(index);
      if (before.carrier == kNone) break;
      const engine::Body& connector = model.bodies[before.body];
      const Mat3& turn = before.carrierInLink.rotation;
      mass += connector.mass;
      inertia += turn.transpose() * connector.inertia * turn;
    }
    const Link& link = trees.links[index];
    const engine::Body& b = model.bodies[link.body];
    put(R"(<body name="{}")", bodyName(link.body));
    Pose place = compose(zero, {b.linkOrigin, Mat3::Identity()});
    if (parent != kNone) place.position -= model.bodies[trees.links[parent].body].linkOrigin;
    putPose(place);
    put(">\n");
    const std::vector<Inertial> parts = inertialsOf(b, mass, inertia);
    putInertial(b, parts.front());
    for (const std::size_t i : chain) putJoint(trees.links[i]);
    putGeoms(link.body, 0, parts.size());
    out += constraints.sites(link.body);
    for (std::size_t part = 1; part < parts.size(); ++part) {
      put(R"(<body name="{}">)", partName(link.body, part));
      putInertial(b, parts[part]);
      putGeoms(link.body, part, parts.size());
      put("</body>\n");
    }
    for (const Index child : children[index]) putLink(child);
    put("</body>\n");
  }

  void putMeshes() {
    put("<asset>\n");
    for (Index i = 0; i < model.geoms.size(); ++i) {
      const engine::ShapeDescription& s = model.geoms[i].shape;
      // Geoms that share a mesh share one here.
      const engine::Mesh* const mesh = isNothing(i) ? nullptr : meshFor(i);
      const std::span<const Piece> parts = piecesFor(i);
      if (mesh && parts.empty() && meshOf.emplace(mesh, i).second) {
        put(R"(<mesh name="m{}" vertex="{}")", i, fmt::join(mesh->vertices, " "));
        // Of vertices alone MuJoCo makes the triangles itself.
        if (!mesh->triangles.empty()) put(R"( face="{}")", fmt::join(mesh->triangles, " "));
        put("/>");
      }
      if (!parts.empty() && piecesIn.emplace(mesh, i).second)
        for (std::size_t k = 0; k < parts.size(); ++k)
          put(R"(<mesh name="m{}p{}" vertex="{}"/>)", i, k, fmt::join(parts[k], " "));
      // Its heights are written to the compiled model: see takeHeights().
      if (s.shape == Shape::heightField)
        put(R"(<hfield name="{}" ncol="{}" nrow="{}" size="{} {} {} {}"/>)", geomName(i), s.heightField->columns,
            s.heightField->rows, s.heightField->width / 2, s.heightField->depth / 2, spanOf(*s.heightField),
            model.extensions.geoms[i].get<SurfaceNumbers>().thickness);
    }
    put("</asset>\n");
  }
};

/// One actuator for each coordinate with an axis; its numbers are written in each step.
void putActuators(Writer& w) {
  for (const Link& link : w.trees.links) {
    if (link.joint == kNone || w.model.joints[link.joint].type == JointType::ball) continue;
    for (int c = 0; c < coordinatesOf(w.model.joints[link.joint].type); ++c)
      w.put(R"(<general name="{0}" joint="{0}" gainprm="0" biastype="affine" biasprm="0 0 0"/>)",
            jointName(link.joint, c));
  }
}

}  // namespace

double spanOf(const engine::HeightField& f) { return std::max(double(f.high) - f.low, 1e-6); }

OptionNumbers optionsOf(const Model& model) { return model.extensions.world.get<OptionNumbers>(); }

bool hasActuators(const Model& model) { return optionsOf(model).integrator == 1; }

bool hasOwnDrag(const Model& model) {
  const OptionNumbers o = optionsOf(model);
  const auto hasDrag = [](const engine::Blocks& b) { return b.get<SurfaceNumbers>().ellipsoidDrag != 0; };
  const auto& geoms = model.extensions.geoms;
  return (o.density > 0 || o.viscosity > 0) && o.integrator != 1 && std::none_of(geoms.begin(), geoms.end(), hasDrag);
}

Written toMjcf(const Model& model, const Trees& trees, double step, const Sizes& sizes, const Constraints& constraints,
               const MeshPieces& pieces) {
  Writer w{model, trees, constraints, pieces, step, {}, {}, {}};
  w.children.resize(trees.links.size());
  for (Index i = 0; i < trees.links.size(); ++i)
    if (trees.links[i].parent != kNone) w.children[trees.links[i].parent].push_back(i);
  w.geoms.resize(model.bodies.size());
  for (Index i = 0; i < model.geoms.size(); ++i)
    if (model.geoms[i].body != kNone) w.geoms[model.geoms[i].body].push_back(i);

  w.put("<mujoco>\n");
  w.put(R"(<compiler angle="radian" inertiafromgeom="false" balanceinertia="true"/>)");
  const OptionNumbers o = optionsOf(model);
  const bool ownDrag = hasOwnDrag(model);
  w.put(R"(<option timestep="{}" gravity="{}" integrator="{}" cone="{}" solver="{}" iterations="{}")", step,
        Writer::text(model.parameters.gravity), OptionNumbers::kIntegrators[static_cast<std::size_t>(o.integrator)],
        OptionNumbers::kCones[static_cast<std::size_t>(o.cone)],
        OptionNumbers::kSolvers[static_cast<std::size_t>(o.solver)], o.iterations);
  w.put(R"( tolerance="{}" impratio="{}" density="{}" viscosity="{}" wind="{}")", o.tolerance, o.impratio,
        ownDrag ? 0 : o.density, ownDrag ? 0 : o.viscosity, fmt::join(o.wind, " "));
  w.put(R"( noslip_iterations="{}" noslip_tolerance="{}" mpr_iterations="{}" mpr_tolerance="{}")", o.noslipIterations,
        o.noslipTolerance, o.mprIterations, o.mprTolerance);
  w.put(R"( o_margin="{}" o_solref="{}" o_solimp="{}">)", o.overrideMargin, fmt::join(o.overrideSolref, " "),
        fmt::join(o.overrideSolimp, " "));
  const auto flag = [](std::int64_t on) { return on != 0 ? "enable" : "disable"; };
  w.put(R"(<flag refsafe="{}" override="{}" multiccd="{}"/></option>)", flag(o.refsafe), flag(o.overrides),
        flag(o.multiccd));
  w.put(R"(<size nconmax="{}" njmax="{}"/>)", sizes.contacts, sizes.rows);
  w.putMeshes();
  w.put("<worldbody>\n");
  for (Index i = 0; i < model.geoms.size(); ++i)
    if (model.geoms[i].body == kNone) w.putGeom(i);
  w.out += constraints.sites(kNone);
  for (std::size_t i = 0; i < trees.links.size(); ++i)
    if (trees.links[i].parent == kNone) w.putLink(i);
  w.put("</worldbody>\n");
  w.put("<actuator>\n");
  if (hasActuators(model)) putActuators(w);
  w.out += constraints.actuators();
  w.put("</actuator>\n");
  w.out += constraints.text();
  w.put("</mujoco>\n");
  return {std::move(w.out), std::move(w.raised)};
}

}  // namespace spark::mujoco
