#include "system.h"

namespace spark::articulated {

void System::changed(const Row& row) {
  // The body that the row is a part of. Rows of the dense system change no body.
  const auto a = static_cast<std::size_t>(row.nodeA);
  const auto index = static_cast<int>(&row - rows.begin());
  const auto isEdgeOf = [&](const Node& node) {
    return index >= node.firstRow && index < node.firstRow + node.rowCount;
  };
  if (row.inBody || isEdgeOf(trees.nodes[a]))
    trees.nodes[a].changed = true;
  else if (row.nodeB >= 0 && isEdgeOf(trees.nodes[static_cast<std::size_t>(row.nodeB)]))
    trees.nodes[static_cast<std::size_t>(row.nodeB)].changed = true;
}

void System::factor() {
  if (trees.factor(rows) && coupling.size() > 0) coupling.form(trees, rows);
}

void System::push(const Row& row, double force) {
  trees.nodes[static_cast<std::size_t>(row.nodeA)].load.add(row.a, force);
  if (row.nodeB >= 0) trees.nodes[static_cast<std::size_t>(row.nodeB)].load.add(row.b, force);
}

void System::readForces() {
  for (const Node& node : trees.nodes)
    for (int i = 0; i < node.rowCount; ++i) {
      Row& row = rows[node.firstRow + i];
      if (row.holds()) row.force = node.joined[i];
    }
  for (Row& row : rows) {
    if (!row.holds())
      row.force = row.bound();
    else if (row.inBody)
      row.force = (row.target - trees.along(row)) / row.softness;
  }
}

void System::solve() {
  factor();
  for (Node& node : trees.nodes) node.load = node.given;
  for (const Row& row : rows) {
    if (!row.holds()) {
      if (const double force = row.bound(); force != 0) push(row, force);
    } else if (row.inBody) {
      push(row, row.target / row.softness);
    }
  }
  trees.forward(true);
  if (coupling.size() > 0) coupling.solve(trees, rows, true);
  trees.backward();
  readForces();
}

void System::respond(const Row& row) {
  factor();
  for (Node& node : trees.nodes) node.load = Six::zero();
  push(row, 1);
  trees.forward(false);
  if (coupling.size() > 0) coupling.solve(trees, rows, false);
  trees.backward();
}

}  // namespace spark::articulated
