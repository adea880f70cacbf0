#pragma once
/// \file
/// What the numbers of a percept are, for modifiers that change them.

#include <cmath>

#include "spark/abi/api/measurement.h"
#include "spark/interface.h"

namespace spark {

/// What the numbers of a percept are.
struct Measured {
  enum class Kind {
    numbers,   ///< each by itself
    rotation,  ///< four numbers, a quaternion w x y z of length 1
    pose,      ///< sixteen numbers, a 4x4 matrix, row-major: a rotation, and a position [m]
    pixels     ///< none: the sensor applies modifiers of numbers to its pixels itself
  };
  Kind kind = Kind::numbers;
  double least = -HUGE_VAL, most = HUGE_VAL;  ///< no modifier makes another number smaller or larger
  double nothing = std::nan("");              ///< the number that says that nothing was measured; NaN: there is none
};

/// Says what the numbers of its percepts are. Offered by perceptors whose numbers cannot be any numbers.
class IMeasurement {
 public:
  SPARK_INTERFACE(IMeasurement, 1);
  virtual ~IMeasurement() = default;
  /// As of now. Called in the sense phase, in any thread.
  virtual Measured measured() const = 0;
};

}  // namespace spark
