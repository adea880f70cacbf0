#pragma once
/// \file
/// Follows the ball through monitor messages.

#include <optional>
#include <string>
#include <vector>

namespace spark::test {

/// The ball's positions in full and diff messages, with each change once: "x y z" [m], six significant digits.
class BallPath {
 public:
  void feed(const std::string& message);
  const std::vector<std::string>& positions() const { return positions_; }

 private:
  std::optional<std::size_t> node_;  ///< index of the ball among the scene's top nodes
  std::vector<std::string> positions_;
};

/// True if `ours` contains all elements of `recorded` after its first move, in the same order. `ours` may have more,
/// because messages may have been lost during the recording.
bool samePath(const std::vector<std::string>& recorded, const std::vector<std::string>& ours);

}  // namespace spark::test
