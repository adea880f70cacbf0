#pragma once
/// \file
/// A world in MuJoCo: its model and data, and how the state goes there and back.

#include <algorithm>
#include <unordered_map>

#include "api/engine.h"
#include "library.h"
#include "mjcf.h"

namespace spark::mujoco {

// A vector and a rotation in MuJoCo's memory.
inline Vec3 toVec(const mjtNum* v) { return {v[0], v[1], v[2]}; }
inline auto rotationAt(const mjtNum* m) { return Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(m); }

/// A pair of elements, whichever is first.
inline std::uint64_t pairOf(Index a, Index b) { return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b); }

/// A model and its data.
struct Compiled {
  ModelPointer model;
  DataPointer data;
  /// Numbers of bodies, joints and geoms by name: mj_name2id() compares them one by one.
  std::unordered_map<std::string, int> bodies, joints, geoms;
  std::vector<std::uint64_t> raised;  ///< as in Written
};
/// Compiles a world; in any thread. Throws Error with MuJoCo's message. `ahead`: its memory is there when the first
/// step begins, at the cost of time now.
Compiled compileWorld(Written world, bool ahead = false);

class MujocoWorld {
 public:
  /// `trees`, `compiled` and `pieces` are those of toMjcf() for this model.
  MujocoWorld(const engine::Model& model, Trees trees, Compiled compiled, const MeshPieces& pieces);
  /// Which pairs of geoms may collide until the next detect().
  void setFilter(engine::PairFilter filter) { filter_ = filter; }
  /// Goes on with another model, of which only those trees move that are unchanged: until it is compiled.
  void bind(const engine::Model& model);

  /// Appends the contacts of the present poses, at most `perPair` of two geoms: the others are not solved.
  void detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int perPair,
              engine::Contacts& out);
  void step(engine::Step& step);

  /// Writes what the next step depends on and the state does not have: coordinates to the last bit.
  void save(const engine::State& state, StateWriter& out) const;
  /// What save() wrote.
  struct Saved {
    std::vector<double> numbers;
    std::vector<std::uint8_t> taken;
    explicit Saved(StateReader& in);
  };
  /// Goes on from it. Throws Error where it does not fit.
  void resume(const Saved& saved, const engine::State& state);

  const Trees& trees() const { return trees_; }
  /// Takes over the activations of actuators from the world before.
  void takeActivations(const MujocoWorld& before);
  /// True when MuJoCo had too little room for contacts or constraints: it dropped some, and wants larger sizes.
  bool isFull() const;
  /// The first joint that has a law which MuJoCo alone could not step; kNone: there is none. See mujoco_laws.cpp.
  Index stiffJoint() const { return stiffJoint_; }
  /// MuJoCo's last warning since the last call; "": none.
  std::string takeMessage() { return std::exchange(message_, {}); }

 private:
  /// The motor that acts on a degree of freedom.
  struct DofMotor {
    Index joint = kNone;
    int axis = 0;
  };
  /// Writes to MuJoCo's coordinates the state of those trees in which other code has written a body. False: there was
  /// none.
  bool take(const engine::Model& model, const engine::State& state);
  void takeLink(const engine::Model& model, const engine::State& state, Index index);
  /// Computes pose and velocity of a connector whose joint belongs to another body in MuJoCo.
  void giveConnector(const engine::Model& model, engine::State& state, Index index);
  /// Writes MuJoCo's poses and velocities to the state.
  void give(const engine::Model& model, engine::State& state);
  /// A body's state was written from MuJoCo.
  void given(engine::State& state, Index body);
  /// Positions, contacts and constraints of the present coordinates.
  void prepare(const engine::Model& model);
  /// The same in a step, where the contacts of the last detect() have another order then: their forces are not read.
  void prepareAgain(const engine::Model& model);
  /// Passes the motors' forces. Returns true when a motor began or ceased to act: prepare() has to run again.
  bool passMotors(const engine::State& state);
  void applyForces(const engine::Model& model, const engine::State& state);
  /// A force, and its torque about the centre of mass of the tree; world frame.
  struct Wrench {
    Vec3 torque = Vec3::Zero(), force = Vec3::Zero();
    void operator+=(const Wrench& w) { torque += w.torque, force += w.force; }
  };
  bool isFree(int body) const;
  template <class F>
  void forEachNumber(F f) const;
  void addBodyDamping(const engine::Model& model, Index body, Vec3& force, Vec3& torque) const;
  Wrench dragOf(int body) const;
  /// Centre of mass of the body of the model that has one of MuJoCo's, all its parts together; world frame.
  Vec3 centreOf(int body) const;
  /// A point of one of MuJoCo's bodies, relative to the centre of mass of its tree, and its velocity; world frame.
  Vec3 armOf(int body, const Vec3& point) const;
  Vec3 velocityOf(int body, const Vec3& point) const;
  void passSpeeds(const engine::State& state);
  /// Controllers, and the springs of joints, implicit where they are stiff.
  void applyLaws(const engine::State& state);
  void applyControl(const engine::AxisControl& control);
  /// Writes a controller's numbers to its actuator.
  void passControl(const engine::Control& control, int joint, double sign);
  void applySprings();
  /// Adds what makes laws implicit to MuJoCo's inertias.
  void addInertias();
  /// Acceleration of a coordinate per force along it, with all others free.
  double mobilityOf(int dof);
  /// The controls of actuators.
  void passInputs(const engine::State& state);
  /// All that acts in one stage of a step.
  void act();
  /// Integrates by Runge and Kutta's method of fourth order.
  void integrate(engine::Step& step);
  static void onStage(void* world);
  /// Steps from the present coordinates. Returns false when MuJoCo met numbers that are too large or
  /// none; all coordinates are to be reset then.
  bool run(engine::Step& step);
  /// Puts the bodies of the tree whose numbers were bad to rest in the state, without forces, and lists them.
  void stopBadTree(engine::State& state, std::vector<Index>& stopped);
  /// Finds the contacts beyond `perPair_` of their pair: sets spare_.
  void findSpare();
  /// The same for the contacts of one pair, of which there are more.
  void thinOut(std::span<const std::pair<std::uint64_t, int>> pair);
  /// What happens to a contact: it is reported, or it is one too many and only solved, or not even that.
  enum class Use : std::uint8_t { reported, solved, dropped };
  Use useOf(int contact) const { return spare_.empty() ? Use::reported : spare_[static_cast<std::size_t>(contact)]; }
  /// True for the pieces of a static mesh: a pair of those touches in more points than a hull would.
  bool isPiece(int geom) const;
  /// Lists the pairs whose contacts are not to be solved, and takes their force.
  void findUnsolved(std::span<const engine::Contact> contacts);
  void releaseUnsolved();
  void readContactForces(std::span<engine::Contact> contacts) const;
  /// The force of a contact on one of its geoms, world frame [N].
  Vec3 forceOf(int contact, Index on) const;
  static bool mayTouch(void* world, int geom1, int geom2);
  void bindMotors(const engine::Joint& j, Index joint, const std::array<int, 3>& mujocoJoints);
  /// What a link was made of: identities in the model, 0: none; and MuJoCo's numbers.
  struct Origin {
    std::uint64_t body = 0, joint = 0, attachedAt = 0;
    int mujocoBody = -1;
    std::array<int, 3> mujocoJoints{-1, -1, -1};
    std::vector<int> joints;  ///< all of the link, in MuJoCo's order
    std::vector<int> parts;   ///< MuJoCo's bodies beside its own, for its further parts
  };

  Trees trees_;                       ///< kNone as body and joint of a link: its tree is gone
  std::vector<Origin> origins_;       ///< by link
  std::vector<std::uint32_t> taken_;  ///< by link: the version of its body's state that is in MuJoCo; 0: none
  std::vector<Index> linkOf_;         ///< by body; kNone: none
  std::vector<std::uint64_t> geoms_;  ///< by MuJoCo's geom: identity in the model; 0: none
  ModelPointer m_;
  DataPointer d_;
  std::vector<int> bodyId_;  ///< MuJoCo's, by body; -1: it does not move yet
  OptionNumbers options_;
  bool ownDrag_ = false;          ///< see hasOwnDrag()
  std::vector<Index> rootOf_;     ///< by link: the first of its tree
  std::vector<Index> geomOf_;     ///< by MuJoCo's geom; kNone: it was removed
  std::vector<DofMotor> motors_;  ///< by degree of freedom
  /// MuJoCo's joint, -1: none, and the sign of its coordinate against the model's angle.
  struct Coordinate {
    int id = -1;
    double sign = 1;
  };
  std::vector<std::array<Coordinate, 3>> coordinates_;  ///< by joint and axis of the angle
  std::vector<int> actuators_;                          ///< by MuJoCo's joint: its actuator; empty: there are none
  std::vector<std::uint64_t> joined_;                   ///< pairs of bodies that joints connect, sorted
  std::vector<std::uint64_t> ghosts_;                   ///< pairs of geoms whose contacts are not solved, sorted
  int perPair_ = 16;                                    ///< of the last detect()
  std::vector<Use> spare_;                              ///< by MuJoCo's contact; empty: all are reported
  std::vector<std::pair<std::uint64_t, int>> pairs_;    ///< of findSpare(): pair of geoms, contact
  std::vector<double> apart_;     ///< of thinOut(): squared distance from the chosen ones; -1: is one
  PieceContacts pieceContacts_;   ///< of static meshes
  std::vector<Wrench> wrenches_;  ///< of applyForces(), by MuJoCo's body
  // Of applyLaws(), by degree of freedom: the force per velocity after the step, and what mobilityOf() works with.
  std::vector<double> resistances_, mobilities_;
  bool resists_ = false;  ///< any of them does
  Index stiffJoint_ = kNone;
  // By MuJoCo's body, as compiled: what the model has now may be later.
  std::vector<Vec3> linkOrigins_;       ///< see Body::linkOrigin
  std::vector<std::uint8_t> hasParts_;  ///< it is the first of several parts
  std::vector<Vec3> boxes_;             ///< by MuJoCo's body: edges of the box that has its inertia [m]
  std::vector<std::uint8_t> stale_;     ///< of take(), by link: its tree has to be written
  bool prepared_ = false;               ///< contacts and constraints are those of the present coordinates
  std::vector<int> listed_;             ///< MuJoCo's contacts, in the order of the last detect()
  engine::PairFilter filter_ = nullptr;
  const engine::Model* model_ = nullptr;  ///< while MuJoCo runs
  const engine::State* state_ = nullptr;  ///< while it steps
  /// MuJoCo's actuators that have an input in the state, by the kind of their block.
  std::vector<std::pair<std::uint64_t, int>> inputs_;
  std::vector<std::uint64_t> chosen_;  ///< pairs of geoms with a surface of their own, sorted
  std::string message_;                ///< MuJoCo's last one
};

}  // namespace spark::mujoco
