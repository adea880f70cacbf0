#pragma once
/// \file
/// Which bodies do not collide because joints connect them: the rule for every engine (docs/engines.md).

#include <algorithm>
#include <numeric>
#include <vector>

#include "api/model.h"
#include "spark/abi/api/joined_bodies.h"

namespace spark::engine {

/// Calls `visit(a, b)` for each two bodies that do not collide because a joint connects them, directly or by a chain of
/// connectors (Body::connector). A pair may be visited several times and in either order. The static world is no body:
/// what is jointed to it collides with static geoms.
template <class Visit>
void forEachJoined(const Model& model, Visit visit) {
  if (model.parameters.joinedCollide) return;
  const auto isConnector = [&](Index body) { return body != kNone && model.bodies[body].connector; };
  bool connectors = false;
  for (const Joint& j : model.joints) {
    if (j.b != kNone) visit(j.a, j.b);
    connectors |= isConnector(j.a) || isConnector(j.b);
  }
  if (!connectors) return;

  // Connectors that joints connect are one group, named by its first; its other neighbours are connected.
  std::vector<Index> group(model.bodies.size());
  std::iota(group.begin(), group.end(), Index{0});
  const auto find = [&](Index body) {
    while (group[body] != body) body = group[body] = group[group[body]];
    return body;
  };
  for (const Joint& j : model.joints) {
    if (!isConnector(j.a) || !isConnector(j.b)) continue;
    const Index a = find(j.a), b = find(j.b);
    group[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::pair<Index, Index>> neighbours;  // group, body
  for (const Joint& j : model.joints) {
    if (j.a == kNone || j.b == kNone || isConnector(j.a) == isConnector(j.b)) continue;
    neighbours.emplace_back(find(isConnector(j.a) ? j.a : j.b), isConnector(j.a) ? j.b : j.a);
  }
  std::sort(neighbours.begin(), neighbours.end());
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    for (std::size_t k = i + 1; k < neighbours.size() && neighbours[k].first == neighbours[i].first; ++k)
      if (neighbours[i].second != neighbours[k].second) visit(neighbours[i].second, neighbours[k].second);
}

}  // namespace spark::engine
