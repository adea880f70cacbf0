#include "elimination.h"

namespace spark::articulated {

namespace {

void gatherOwn(Node& node, const std::vector<Row>& rows) {
  Block& m = node.gathered;
  m = {};
  double* numbers = m.numbers();
  for (int i = 0; i < 3; ++i) {
    numbers[7 * i] = node.body->mass;
    for (int j = 0; j < 3; ++j) numbers[6 * (3 + i) + 3 + j] = node.inertia(i, j);
  }
  for (int r = node.groundRow; r >= 0; r = rows[static_cast<std::size_t>(r)].next) {
    const Row& row = rows[static_cast<std::size_t>(r)];
    if (row.holds()) addSquare(m, row.a, 1 / row.softness);
  }
}

}  // namespace

void Elimination::eliminate(Node& node, const std::vector<Row>& rows) {
  Block m = node.gathered;
  node.own.take(m);
  node.held = false;
  if (node.rowCount == 0) return;
  node.across = {};
  node.up = {};
  node.target = Six::zero();
  Block w{};
  double* across = node.across.numbers();
  const auto self = static_cast<int>(&node - nodes.data());
  for (int r = 0; r < 6; ++r) {
    const Row* row = r < node.rowCount ? &rows[static_cast<std::size_t>(node.firstRow + r)] : nullptr;
    w.row[r].set(r, row && row->holds() ? row->softness : 1);
    if (!row || !row->holds()) continue;
    node.held = true;
    const bool first = row->nodeA == self;
    const Six& mine = first ? row->a : row->b;
    for (int i = 0; i < 6; ++i) across[6 * i + r] = mine[i];
    node.up.row[r] = first ? row->b : row->a;
    node.target.set(r, row->target);
  }
  if (!node.held) return;
  node.own.forward(node.across);
  addCongruence(w, node.across, node.own.inverse);
  node.hold.take(w);
  if (node.parent < 0) return;
  node.hold.forward(node.up);
  node.handed = {};
  addCongruence(node.handed, node.up, node.hold.inverse);
}

bool Elimination::factor(const std::vector<Row>& rows) {
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
    if (node.parent >= 0) nodes[static_cast<std::size_t>(node.parent)].load += timesTransposed(node.up, q * node.hold.inverse);
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
