#pragma once
/// \file
/// The inputs of a cycle as bytes, and back.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/inputs.h"

namespace spark::recorder {

/// Names of channels in a recording, with their encodings.
inline constexpr std::string_view kInputs = "/spark/inputs", kInputsEncoding = "spark-inputs-3";
inline constexpr std::string_view kStates = "/spark/states", kStatesEncoding = "spark-state-3";
inline constexpr std::string_view kHashes = "/spark/hashes";

/// An input that owns its texts.
struct OwnInput {
  Input::Kind kind = Input::Kind::cycle;
  std::string place;
  std::uint64_t key = 0;
  std::int64_t number = 0;
  std::string text;
  bool operator==(const OwnInput&) const = default;
  /// Memory that it takes.
  std::size_t bytes() const { return sizeof *this + place.size() + text.size(); }
};

/// Inputs as they came. The simulation's thread only copies them; they are encoded by the one that writes.
class InputBatch {
 public:
  void add(const Input& input);
  bool empty() const { return entries_.empty(); }
  /// Memory that it takes, until it is encoded.
  std::size_t bytes() const { return entries_.size() * (sizeof(Entry) + sizeof(OwnInput)) + 2 * texts_.size(); }
  /// An empty one with room for as much.
  InputBatch next() const;
  std::vector<OwnInput> inputs() const;

 private:
  struct Entry {
    Input::Kind kind;
    std::uint64_t key;
    std::int64_t number;
    std::size_t place, text;  ///< lengths, in texts_
  };
  std::vector<Entry> entries_;
  std::string texts_;
};

struct InputModel;

/// Writes inputs as pieces, each of which needs those before, back to the last restart. A piece is a varint, its number
/// since then from 0, and bits of a range coder (range_coder.h), whose chances come from the inputs before:
///
///     inputs     kind, number (a difference to the last one of the kind), and if it has them: client, text
///     client     place and key: the one that followed the last one before, another one that is known, or a new one
///     text       its words, each of them beginning with a parenthesis: the one that followed the last one in the texts
///                of this client, another one that is known, or a new one; and the end
///     word       its characters without numbers, once; each time its numbers, as differences to what the client sent
///                last in their place
///
/// A number of a text is a decimal one that is written back with the same characters, not behind a letter, a digit, a
/// point or '_'. What is known is limited, so that no client takes memory with it.
class InputWriter {
 public:
  InputWriter();
  ~InputWriter();
  /// The next piece needs none before.
  void restart();
  /// The inputs as pieces: none if there are none, more than one if they are long. Throws Error if an input has more
  /// than 48 MB; the next piece then needs none before.
  std::vector<std::string> write(std::vector<OwnInput> inputs);

 private:
  std::unique_ptr<InputModel> model_;  ///< nullptr: the next piece needs none before
};

/// Reads the pieces of an InputWriter, from one on that needs none before.
class InputReader {
 public:
  InputReader();
  ~InputReader();
  /// Forgets the pieces before.
  void restart();
  /// Appends the inputs of a piece. Throws Error if it is damaged, or if pieces before it are missing.
  void read(std::string_view piece, std::vector<OwnInput>& out);

 private:
  std::unique_ptr<InputModel> model_;  ///< nullptr: no piece was read since the restart, or a damaged one
};

}  // namespace spark::recorder
