#include "elimination.h"

namespace spark::articulated {

namespace {

void gatherOwn(Node& node, const Rows& rows) {
  Block& m = node.gathered;
  const double mass = node.body->mass;
  const Mat3& j = node.inertia;
  m.row[0] = {Pair{mass, 0}, Pair{0, 0}, Pair{0, 0}};
  m.row[1] = {Pair{0, mass}, Pair{0, 0}, Pair{0, 0}};
  m.row[2] = {Pair{0, 0}, Pair{mass, 0}, Pair{0, 0}};
  m.row[3] = {Pair{0, 0}, Pair{0, j(0, 0)}, Pair{j(0, 1), j(0, 2)}};
  m.row[4] = {Pair{0, 0}, Pair{0, j(0, 1)}, Pair{j(1, 1), j(1, 2)}};
  m.row[5] = {Pair{0, 0}, Pair{0, j(0, 2)}, Pair{j(1, 2), j(2, 2)}};
  for (int r = node.groundRow; r >= 0; r = rows[r].next) {
    const Row& row = rows[r];
    if (row.holds()) addSquare(m, row.a, 1 / row.softness);
  }
}

}  // namespace

namespace {

constexpr Six kNothing{};

/// Rows of a joint that hold, as seen by the child and by the parent; the others are left out.
struct EdgeRows {
  const Six* mine[6];
  const Six* parents[6];
  Six softness, target;
  bool any = false;

  EdgeRows(const Node& node, bool isA, const Row* rows) {
    softness = {Pair{1, 1}, Pair{1, 1}, Pair{1, 1}};
    target = kNothing;
    for (int r = 0; r < 6; ++r) {
      mine[r] = parents[r] = &kNothing;
      if (r >= node.rowCount || !rows[r].holds()) continue;
      any = true;
      mine[r] = isA ? &rows[r].a : &rows[r].b;
      parents[r] = isA ? &rows[r].b : &rows[r].a;
      softness.set(r, rows[r].softness);
      target.set(r, rows[r].target);
    }
  }
};

}  // namespace

void Elimination::eliminate(Node& node, const Rows& rows) {
  Block m = node.gathered;
  node.own.take(m);
  node.held = false;
  if (node.rowCount == 0) return;
  const EdgeRows edge(node, &nodes[static_cast<std::size_t>(rows[node.firstRow].nodeA)] == &node, &rows[node.firstRow]);
  if (!edge.any) return;
  node.held = true;
  node.target = edge.target;
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i)
#pragma GCC unroll 3
    for (int p = 0; p < 3; ++p) node.across.row[i].p[p] = Pair{(*edge.mine[2 * p])[i], (*edge.mine[2 * p + 1])[i]};
  node.own.forward(node.across);
  Block w{};
#pragma GCC unroll 6
  for (int r = 0; r < 6; ++r) w.row[r].set(r, edge.softness[r]);
  addCongruence(w, node.across, node.own.inverse);
  node.hold.take(w);
  if (node.parent < 0) return;
  for (int r = 0; r < 6; ++r) node.up.row[r] = *edge.parents[r];
  node.hold.forward(node.up);
  node.handed = {};
  addCongruence(node.handed, node.up, node.hold.inverse);
}

bool Elimination::factor(const Rows& rows) {
  bool any = false;
  for (auto i = nodes.size(); i-- > 0;) {
    Node& node = nodes[i];
    if (!node.changed || node.parent < 0) continue;
    nodes[static_cast<std::size_t>(node.parent)].changed = true;
  }
  for (Node& node : nodes)
    if (node.changed) gatherOwn(node, rows);
  for (auto i = nodes.size(); i-- > 0;) {
    Node& node = nodes[i];
    if (node.changed) {
      eliminate(node, rows);
      any = true;
    }
    if (node.parent < 0) continue;
    Node& parent = nodes[static_cast<std::size_t>(node.parent)];
    // The same sums in the same order, whoever changed.
    if (parent.changed && node.held)
      for (int k = 0; k < 6; ++k) parent.gathered.row[k] += node.handed.row[k];
  }
  for (Node& node : nodes) node.changed = false;
  return any;
}

void Elimination::forward(bool targets) {
  for (auto i = nodes.size(); i-- > 0;) {
    Node& node = nodes[i];
    Six z = node.load;
    node.own.forward(z);
    node.z = z;
    if (!node.held) continue;
    const Six pushed = timesTransposed(node.across, z * node.own.inverse);
    Six q = (targets ? node.target : Six::zero()) - pushed;
    node.hold.forward(q);
    node.q = q;
    if (node.parent >= 0)
      nodes[static_cast<std::size_t>(node.parent)].load += timesTransposed(node.up, q * node.hold.inverse);
  }
}

void Elimination::backward() {
  for (Node& node : nodes) {
    Six z = node.z;
    if (node.held) {
      Six x = node.q;
      if (node.parent >= 0) x = x - times(node.up, nodes[static_cast<std::size_t>(node.parent)].motion);
      x = x * node.hold.inverse;
      node.hold.backward(x);
      node.joined = x;
      z += times(node.across, x);
    }
    z = z * node.own.inverse;
    node.own.backward(z);
    node.motion = z;
  }
}

void Elimination::reach(const Row& row, std::vector<Reach>& out) const {
  int a = row.nodeA, b = row.nodeB;
  Six loadA = row.a, loadB = row.b;
  // Two ways up, the deeper one first, until they meet.
  while (a >= 0 || b >= 0) {
    if (a < b) {
      std::swap(a, b);
      std::swap(loadA, loadB);
    }
    if (a == b) {
      loadA += loadB;
      b = -1;
    }
    const Node& node = nodes[static_cast<std::size_t>(a)];
    Reach& r = out.emplace_back();
    r.node = a;
    r.z = loadA;
    node.own.forward(r.z);
    r.scaledZ = r.z * node.own.inverse;
    r.q = r.scaledQ = Six::zero();
    a = -1;
    if (!node.held) continue;
    r.q = Six::zero() - timesTransposed(node.across, r.scaledZ);
    node.hold.forward(r.q);
    r.scaledQ = r.q * node.hold.inverse;
    if (node.parent < 0) continue;
    loadA = timesTransposed(node.up, r.scaledQ);
    a = node.parent;
  }
}

double Elimination::touch(const Reach* a, const Reach* aEnd, const Reach* b, const Reach* bEnd) {
  double sum = 0;
  while (a != aEnd && b != bEnd) {
    if (a->node > b->node)
      ++a;
    else if (b->node > a->node)
      ++b;
    else {
      sum += dot(a->z, b->scaledZ) - dot(a->q, b->scaledQ);
      ++a, ++b;
    }
  }
  return sum;
}

double Elimination::touchLoads(const Reach* a, const Reach* aEnd) const {
  double sum = 0;
  for (; a != aEnd; ++a) {
    const Node& node = nodes[static_cast<std::size_t>(a->node)];
    sum += dot(a->scaledZ, node.z);
    if (node.held) sum -= dot(a->scaledQ, node.q);
  }
  return sum;
}

void Elimination::push(const Reach* a, const Reach* aEnd, double force) {
  for (; a != aEnd; ++a) {
    Node& node = nodes[static_cast<std::size_t>(a->node)];
    node.z.add(a->z, force);
    if (node.held) node.q.add(a->q, force);
  }
}

}  // namespace spark::articulated
