#pragma once

namespace spark::soccer {

/// The fouls of the automatic referee. The numbers are those of the monitor protocol; 3 (illegal attack) and 5 (illegal
/// kick-off) are reserved there and never used.
enum class Foul {
  crowding = 0,
  touching = 1,
  illegalDefence = 2,
  incapable = 4,
  charging = 6,
  selfCollision = 7,
  ballHolding = 8,
};

/// Name of a foul for the log.
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
