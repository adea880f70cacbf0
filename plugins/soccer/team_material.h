#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "api/scene.h"
#include "play_mode.h"

namespace spark::soccer {

/// Replaces the team materials of a robot: matTeam, matLeft and matRight by matLeft or matRight; matNum... by
/// matNum<unum>. May be called again when the team swaps sides.
inline void setTeamMaterials(Node& robot, Side side, int unum) {
  std::vector<IVisual*> visuals;
  robot.collect(visuals);
  const std::string team = side == Side::left ? "matLeft" : "matRight";
  for (IVisual* v : visuals) {
    if (v->kind() == IVisual::Kind::light) continue;
    for (std::size_t i = 0; i < v->materials().size(); ++i) {
      const std::string& old = v->materials()[i];
      if (old == "matTeam" || old == "matLeft" || old == "matRight")
        v->setMaterialName(i, team);
      else if (old.starts_with("matNum"))
        v->setMaterialName(i, fmt::format("matNum{}", unum));
    }
  }
}

}  // namespace spark::soccer
