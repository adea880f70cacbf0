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
inline constexpr std::string_view kInputs = "/spark/inputs", kInputsEncoding = "spark-inputs-2";
inline constexpr std::string_view kStates = "/spark/states", kStatesEncoding = "spark-state-2";
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

/// Writes inputs as bytes. A piece:
///
///     varint size, inputs     each: u8 kind, varint number, and if it has them: place, varint key, text
///     u8 bytes of numbers     the lowest byte of each, then the second one of each, ...: four in all
///
/// Numbers of inputs are folded (2 n, or -2 n - 1), times are differences to the last one of the piece. Most of what
/// agents send is decimal numbers in texts that are otherwise the same in each cycle. So a text stands without them:
/// the byte k, 1 to 6, is a number with k decimals; the number is that of its digits, doubled, plus one if it is
/// negative. A kind with 0x80 has a text that stands as it is.
class InputWriter {
 public:
  void add(const Input& input);
  /// The bytes so far, a piece that can be read without others. They are forgotten.
  std::string take();

 private:
  void text(std::string_view v);
  bool split(std::string_view text);
  std::string bytes_;
  std::vector<std::uint32_t> decimals_;  ///< numbers of the texts
  std::string template_;                 ///< a text without its numbers
  std::int64_t lastTime_ = 0;
};

/// Appends the inputs of a piece. Throws Error if it is damaged.
void readInputs(std::string_view piece, std::vector<OwnInput>& out);

}  // namespace spark::recorder
