#include "walk.h"

namespace humanoid {

// Found by a search in simulation.
const Gait& gaitOf(int type) {
  static const Gait usual{0.4524, 0.9242, 0.0278, 0.0451, 0.0115, 0.6894, -0.0062, 0.0013, 0.0398,
                          0.0448, 0.0015, 0.1144, 0.0049, 0.4421, 0.0948, 1.1091,  0.6441};
  static const std::array<Gait, kRobotTypes> gaits{usual, usual, usual, usual, usual};
  return gaits.at(static_cast<std::size_t>(type));
}

}  // namespace humanoid
