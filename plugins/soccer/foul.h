#pragma once

namespace spark::soccer {

/// What the automatic referee judges. The numbers are those that monitors are told (protocol section 6.7); 3 and 5 are
/// never used.
enum class Foul {
  crowding = 0,
  touching = 1,
  illegalDefence = 2,
  incapable = 4,
  charging = 6,
  selfCollision = 7,
  ballHolding = 8,
};

constexpr const char* foulName(Foul foul) {
  switch (foul) {
    case Foul::crowding:
      return "crowding";
    case Foul::touching:
      return "touching";
    case Foul::illegalDefence:
      return "illegal defence";
    case Foul::incapable:
      return "incapable";
    case Foul::charging:
      return "charging";
    case Foul::selfCollision:
      return "self-collision";
    case Foul::ballHolding:
      return "ball holding";
  }
  return "foul";
}

}  // namespace spark::soccer
