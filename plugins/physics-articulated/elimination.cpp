#include "elimination.h"

namespace spark::articulated {

namespace {

constexpr SpatialVector kZero{};

/// M of a body with its folded rows, without its children.
void setOwnInertia(Node& node, const Rows& rows) {
  // diag(m, m, m) and the inertia tensor; the upper triangle counts.
  SpatialMatrix& m = node.inertia;
  const double mass = node.body->mass;
  const Mat3& inertia = node.worldInertia;
  m.row[0] = {DoublePair{mass, 0}, DoublePair{0, 0}, DoublePair{0, 0}};
  m.row[1] = {DoublePair{0, mass}, DoublePair{0, 0}, DoublePair{0, 0}};
  m.row[2] = {DoublePair{0, 0}, DoublePair{mass, 0}, DoublePair{0, 0}};
  m.row[3] = {DoublePair{0, 0}, DoublePair{0, inertia(0, 0)}, DoublePair{inertia(0, 1), inertia(0, 2)}};
  m.row[4] = {DoublePair{0, 0}, DoublePair{0, inertia(0, 1)}, DoublePair{inertia(1, 1), inertia(1, 2)}};
  m.row[5] = {DoublePair{0, 0}, DoublePair{0, inertia(0, 2)}, DoublePair{inertia(1, 2), inertia(2, 2)}};
  // M += J^T D^-1 J.
  for (Index r = node.firstFolded; r != kNone; r = rows[r].nextFolded) {
    const Row& row = rows[r];
    if (row.holds()) addOuterProduct(m, row.jacobianA, 1 / row.softness);
  }
}

/// The active rows of a tree joint. The others have 0 in J, K and r and 1 in D.
struct ActiveRows {
  const SpatialVector* child[6];   ///< rows of J
  const SpatialVector* parent[6];  ///< rows of K
  SpatialVector softness, target;  ///< D, r
  bool any = false;

  /// `childIsA`: the child is body A of the joint.
  ActiveRows(const Node& node, bool childIsA, const Row* rows) {
    softness = {DoublePair{1, 1}, DoublePair{1, 1}, DoublePair{1, 1}};
    target = kZero;
    for (int r = 0; r < 6; ++r) {
      child[r] = parent[r] = &kZero;
      if (static_cast<Index>(r) >= node.rowCount || !rows[r].active()) continue;
      any = true;
      child[r] = childIsA ? &rows[r].jacobianA : &rows[r].jacobianB;
      parent[r] = childIsA ? &rows[r].jacobianB : &rows[r].jacobianA;
      softness.set(r, rows[r].totalSoftness());
      target.set(r, rows[r].totalTarget());
    }
  }
};

}  // namespace

void Elimination::factorNode(Node& node, const Rows& rows) {
  // M = L_M D_M L_M^T. The factorisation overwrites its argument.
  SpatialMatrix m = node.inertia;
  node.inertiaFactor.factorize(m);
  node.connected = false;
  if (node.rowCount == 0) return;
  const ActiveRows active(node, &nodes[rows[node.firstRow].nodeA] == &node, &rows[node.firstRow]);
  if (!active.any) return;
  node.connected = true;
  node.target = active.target;
  // L_M^-1 J^T.
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i)
#pragma GCC unroll 3
    for (int p = 0; p < 3; ++p)
      node.halfJ.row[i].pair[p] = DoublePair{(*active.child[2 * p])[i], (*active.child[2 * p + 1])[i]};
  node.inertiaFactor.solveLower(node.halfJ);
  // W = D + (L_M^-1 J^T)^T D_M^-1 (L_M^-1 J^T) = L_W D_W L_W^T.
  SpatialMatrix w{};
#pragma GCC unroll 6
  for (int r = 0; r < 6; ++r) w.row[r].set(r, active.softness[r]);
  addCongruence(w, node.halfJ, node.inertiaFactor.inverseD);
  node.delassusFactor.factorize(w);
  if (node.parent == kNone) return;
  // L_W^-1 K, and K^T W^-1 K = (L_W^-1 K)^T D_W^-1 (L_W^-1 K).
  for (int r = 0; r < 6; ++r) node.halfK.row[r] = *active.parent[r];
  node.delassusFactor.solveLower(node.halfK);
  node.parentInertia = {};
  addCongruence(node.parentInertia, node.halfK, node.delassusFactor.inverseD);
}

bool Elimination::factor(const Rows& rows) {
  // A node that changed changes all nodes above it.
  for (auto i = nodes.size(); i-- > 0;) {
    const Node& node = nodes[i];
    if (node.changed && node.parent != kNone) nodes[node.parent].changed = true;
  }
  for (Node& node : nodes)
    if (node.changed) setOwnInertia(node, rows);
  // From the leaves to the roots. A parent sums up all children in the same order, whichever of them changed, so that
  // the digits do not depend on what was solved before.
  bool any = false;
  for (auto i = nodes.size(); i-- > 0;) {
    Node& node = nodes[i];
    if (node.changed) {
      factorNode(node, rows);
      any = true;
    }
    if (node.parent == kNone) continue;
    Node& parent = nodes[node.parent];
    if (parent.changed && node.connected)
      for (int k = 0; k < 6; ++k) parent.inertia.row[k] += node.parentInertia.row[k];
  }
  for (Node& node : nodes) node.changed = false;
  return any;
}

void Elimination::forward(bool useTargets) {
  for (auto i = nodes.size(); i-- > 0;) {
    Node& node = nodes[i];
    // z = L_M^-1 f.
    SpatialVector z = node.force;
    node.inertiaFactor.solveLower(z);
    node.z = z;
    if (!node.connected) continue;
    // q = L_W^-1 (r - J M^-1 f), where J M^-1 f = (L_M^-1 J^T)^T D_M^-1 z.
    const SpatialVector response = multiplyTransposed(node.halfJ, z * node.inertiaFactor.inverseD);
    SpatialVector q = (useTargets ? node.target : SpatialVector::zero()) - response;
    node.delassusFactor.solveLower(q);
    node.q = q;
    // f_p += K^T W^-1 (r - J M^-1 f) = (L_W^-1 K)^T D_W^-1 q.
    if (node.parent != kNone)
      nodes[node.parent].force += multiplyTransposed(node.halfK, q * node.delassusFactor.inverseD);
  }
}

void Elimination::backward() {
  for (Node& node : nodes) {
    SpatialVector z = node.z;
    if (node.connected) {
      // x = W^-1 (r - J M^-1 f - K u_p) = L_W^-T D_W^-1 (q - L_W^-1 K u_p).
      SpatialVector x = node.q;
      if (node.parent != kNone) x = x - multiply(node.halfK, nodes[node.parent].motion);
      x = x * node.delassusFactor.inverseD;
      node.delassusFactor.solveLowerTransposed(x);
      node.jointForces = x;
      z += multiply(node.halfJ, x);
    }
    // u = M^-1 (f + J^T x) = L_M^-T D_M^-1 (z + L_M^-1 J^T x).
    z = z * node.inertiaFactor.inverseD;
    node.inertiaFactor.solveLowerTransposed(z);
    node.motion = z;
  }
}

void Elimination::appendPathResponse(const Row& row, std::vector<PathTerm>& out) const {
  // forward() for the forces J_A^T and J_B^T alone, which reach only the nodes above the two bodies. The node with the
  // larger index comes first, until both paths are at the same node and join.
  Index a = row.nodeA, b = row.nodeB;
  SpatialVector forceA = row.jacobianA, forceB = row.jacobianB;
  while (a != kNone || b != kNone) {
    if (a == kNone || (b != kNone && a < b)) {
      std::swap(a, b);
      std::swap(forceA, forceB);
    }
    if (a == b) {
      forceA += forceB;
      b = kNone;
    }
    const Node& node = nodes[a];
    PathTerm& term = out.emplace_back();
    term.node = a;
    term.z = forceA;
    node.inertiaFactor.solveLower(term.z);
    term.scaledZ = term.z * node.inertiaFactor.inverseD;
    term.q = term.scaledQ = SpatialVector::zero();
    a = kNone;
    if (!node.connected) continue;
    term.q = SpatialVector::zero() - multiplyTransposed(node.halfJ, term.scaledZ);
    node.delassusFactor.solveLower(term.q);
    term.scaledQ = term.q * node.delassusFactor.inverseD;
    if (node.parent == kNone) continue;
    forceA = multiplyTransposed(node.halfK, term.scaledQ);
    a = node.parent;
  }
}

// J_i T^-1 J_j^T is the sum of z_i^T D_M^-1 z_j - q_i^T D_W^-1 q_j over the nodes that both paths have. The minus comes
// from the pivots of T, which are M > 0 for the motions and -W < 0 for the forces.
double Elimination::delassusTerm(PathResponse i, PathResponse j) {
  double sum = 0;
  const PathTerm *a = i.begin(), *b = j.begin();
  while (a != i.end() && b != j.end()) {
    if (a->node > b->node) {
      ++a;
    } else if (b->node > a->node) {
      ++b;
    } else {
      sum += dot(a->z, b->scaledZ) - dot(a->q, b->scaledQ);
      ++a, ++b;
    }
  }
  return sum;
}

double Elimination::predictedMotion(PathResponse i) const {
  double sum = 0;
  for (const PathTerm& term : i) {
    const Node& node = nodes[term.node];
    sum += dot(term.scaledZ, node.z);
    if (node.connected) sum -= dot(term.scaledQ, node.q);
  }
  return sum;
}

void Elimination::applyForce(PathResponse i, double force) {
  for (const PathTerm& term : i) {
    Node& node = nodes[term.node];
    node.z.addScaled(term.z, force);
    if (node.connected) node.q.addScaled(term.q, force);
  }
}

}  // namespace spark::articulated
