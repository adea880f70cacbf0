#include "recovery.h"

namespace humanoid {

// Found by a search in simulation.
const RecoveryTuning& recoveryOf(int type) {
  static const std::array<RecoveryTuning, kRobotTypes> tunings{{
      {0.289, 0.282, 0.95, 94.3, -2.9, 63.6, 0.2, 0, 13.2, 36.9, -41.7, -15.5, 43.7, 100, -116, 75, 0.135, 0.048},
      {0.323, 0.227, 1, 53.1, -9.7, 53.1, -20.6, 66, 16.3, 74.6, -59, 48.4, 53, 100, -123.1, 74.9, 0.5, 0.02},
      {0.189, 0.41, 1.2, 99.2, 0, 75, 0, 0, -13.4, 35.4, -5, 17.6, 47.2, 100, -105.3, 75, 0.3, 0.02},
      {0.323, 0.228, 1.2, 70.1, 0, 48.7, -9, 74.2, 17.4, 75, -53.8, 54.5, 54.8, 100, -123.6, 72.3, 0.3, 0.02},
      {0.296, 0.449, 0.741, 100, 0, 75, 0, 0, -5.6, 68.3, -22.6, 19.8, 46.4, 100, -123, 64.1, 0, 0.028},
  }};
  return tunings.at(static_cast<std::size_t>(type));
}

}  // namespace humanoid
