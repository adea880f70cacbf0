#pragma once

#include "api/match.h"

namespace spark::soccer {

/// Reads `(See (B (pol d h v)) (P (team Red) (id 3) (head (pol d h v))) (L (pol d h v) (pol d h v)))` for
/// viewers. Base class of both vision perceptors.
class SeeReader : public ISightReader {
 public:
  void read(const Element& see, Sightings& out) const override;
};

}  // namespace spark::soccer
