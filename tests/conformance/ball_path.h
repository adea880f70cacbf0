#pragma once
/// \file
/// Follows the ball through monitor messages.

#include <optional>
#include <string>
#include <vector>

namespace spark::test {

/// The ball's places as full and diff messages tell them, each change once: "x y z" [m], six significant digits.
class BallPath {
 public:
  void feed(const std::string& message);
  const std::vector<std::string>& places() const { return places_; }

 private:
  std::optional<std::size_t> node_;  ///< which of the scene's top nodes is the ball
  std::vector<std::string> places_;
};

/// True when everything that `recorded` has after its first move stands in `ours` too, in that order. Only where a
/// message may have been lost on the recording's way may `ours` have more.
bool samePath(const std::vector<std::string>& recorded, const std::vector<std::string>& ours);

}  // namespace spark::test
