#pragma once

#include <string>
#include <vector>

#include "api/scene.h"
#include "play_mode.h"

namespace spark::soccer {

/// Dresses a robot: matTeam becomes matLeft or matRight, matNum becomes matNum<unum>, in place; a robot that is dressed
/// changes sides.
inline void paintTeam(Node& robot, Side side, int unum) {
  std::vector<IVisual*> visuals;
  robot.collect(visuals);
  const std::string colour = side == Side::left ? "matLeft" : "matRight";
  for (IVisual* v : visuals) {
    if (v->kind() == IVisual::Kind::light) continue;
    for (std::size_t i = 0; i < v->materials().size(); ++i) {
      const std::string& old = v->materials()[i];
      if (old == "matTeam" || old == "matLeft" || old == "matRight")
        v->setMaterialName(i, colour);
      else if (old.starts_with("matNum"))
        v->setMaterialName(i, "matNum" + std::to_string(unum));
    }
  }
}

}  // namespace spark::soccer
