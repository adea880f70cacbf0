#pragma once
/// \file
/// The inputs of a cycle as bytes, and back.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/inputs.h"

namespace spark::recorder {

/// Names of channels in a recording, with their encodings.
inline constexpr std::string_view kInputs = "/spark/inputs", kInputsEncoding = "spark-inputs-1";
inline constexpr std::string_view kStates = "/spark/states", kStatesEncoding = "spark-state-1";
inline constexpr std::string_view kHashes = "/spark/hashes";

/// An input that owns its texts.
struct OwnInput {
  Input::Kind kind = Input::Kind::cycle;
  std::string place;
  std::uint64_t key = 0;
  std::int64_t number = 0;
  std::string text;
  bool operator==(const OwnInput&) const = default;
};

/// Appends inputs to bytes: kind, number, place, key, text, each number as groups of seven bits. Times are differences
/// to the last one of the piece.
class InputWriter {
 public:
  void add(const Input& input);
  /// The bytes so far, a piece that can be read without others. They are forgotten.
  std::string take() {
    lastTime_ = 0;
    return std::exchange(bytes_, {});
  }

 private:
  void number(std::uint64_t v);
  void text(std::string_view v);
  std::string bytes_;
  std::int64_t lastTime_ = 0;
};

/// Appends the inputs of a piece. Throws Error if it is damaged.
void readInputs(std::string_view piece, std::vector<OwnInput>& out);

}  // namespace spark::recorder
