#include "system.h"

namespace spark::articulated {

void System::stateChanged(const Row& row) {
  // A folded row and a row of a tree joint are part of one node: body A's, or that of the joint's child. A coupling row
  // is part of none.
  const Index index = toIndex(static_cast<std::size_t>(&row - rows.begin()));
  const auto isTreeJointOf = [&](const Node& node) {
    return index >= node.firstRow && index < node.firstRow + node.rowCount;
  };
  Node& nodeA = trees.nodes[row.nodeA];
  if (row.folded || isTreeJointOf(nodeA))
    nodeA.changed = true;
  else if (row.nodeB != kNone && isTreeJointOf(trees.nodes[row.nodeB]))
    trees.nodes[row.nodeB].changed = true;
}

void System::factor() {
  if (trees.factor(rows) && coupling.size() > 0) coupling.assemble(trees, rows);
}

/// f += J^T force for both bodies.
void System::addForce(const Row& row, double force) {
  trees.nodes[row.nodeA].force.addScaled(row.jacobianA, force);
  if (row.nodeB != kNone) trees.nodes[row.nodeB].force.addScaled(row.jacobianB, force);
}

void System::readForces() {
  // Rows of tree joints.
  for (const Node& node : trees.nodes)
    for (int i = 0; Row & row : rows.range(node.firstRow, node.rowCount)) {
      if (row.active()) row.force = node.jointForces[i];
      ++i;
    }
  // Rows at bounds, and folded rows: x = D^-1 (r - J u). Coupling wrote its own. The force of a row is without its
  // inertial force.
  for (Row& row : rows) {
    if (!row.holds())
      row.force = row.bound();
    else if (row.folded)
      row.force = (row.target - trees.motionAlong(row)) / row.softness;
    else if (row.inertia > 0)
      row.force -= row.inertia * (row.inertialTarget - trees.motionAlong(row));
  }
}

void System::solve() {
  factor();
  // f: external forces, forces at bounds, and J^T D^-1 r of folded rows.
  for (Node& node : trees.nodes) node.force = node.externalForce;
  for (const Row& row : rows) {
    if (!row.holds()) {
      if (const double force = row.bound(); force != 0) addForce(row, force);
    } else if (row.folded) {
      addForce(row, row.target / row.softness);
    }
  }
  trees.forward(true);
  if (coupling.size() > 0) coupling.solve(trees, rows, true);
  trees.backward();
  readForces();
}

void System::respondTo(const Row& row) {
  factor();
  for (Node& node : trees.nodes) node.force = SpatialVector::zero();
  addForce(row, 1);
  trees.forward(false);
  if (coupling.size() > 0) coupling.solve(trees, rows, false);
  trees.backward();
}

}  // namespace spark::articulated
