#pragma once
/// \file
/// The last minutes of the match, so that a viewer can scroll back while it goes on. I/O thread only.
///
/// Keeps the pieces of PieceBuilder. Any instant is reached at once, because a piece is read without the others.
/// Complete pieces are compressed. The oldest ones are removed when they are older than `seconds`, or when all need
/// more than `bytes`.

#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "stream/piece_builder.h"

namespace spark::web {

class History {
 public:
  /// `seconds`: simulated time that is kept; `bytes`: most memory.
  History(double seconds, std::size_t bytes) : seconds_(seconds), bytes_(bytes) {}

  /// Simulated time from which the next snapshot is wanted [s].
  double due() const { return builder_.due(); }
  /// Least simulated time from one snapshot to the next [s].
  double interval() const { return builder_.interval(); }
  /// Starts a scene; its frames follow. `message`: as sceneMessage() writes it.
  void takeScene(std::uint32_t shape, std::string_view message);
  /// Takes the events of a snapshot and, if it is due, its frame. A time before that of the last frame clears the
  /// history: the simulation was set back. `scene`: that of the shape.
  void take(const Snapshot& snapshot, std::uint32_t shape, const FrameScene& scene);

  bool empty() const { return !builder_.growing(); }
  /// Simulated time of the first and the last frame [s]; 0 if there are none.
  double from() const;
  double to() const { return empty() ? 0 : builder_.newest(); }
  /// Bytes of memory in use, about.
  std::size_t bytes() const { return used_ + (empty() ? 0 : builder_.growing()->content.size()); }

  /// The piece of `time`, or the nearest one, as a binary message. nullptr if there are none. The last piece is not
  /// complete; it is compressed once per frame at most.
  std::shared_ptr<const std::string> pieceAt(double time);
  /// The scene of that shape as a binary message; nullptr if no piece has it.
  std::shared_ptr<const std::string> scene(std::uint32_t shape) const;
  /// The environment at from(), and all changes and events since, without entries that change in every frame, as a JSON
  /// list of messages. If it would be longer than `most` bytes, the oldest ones are omitted.
  std::string outline(std::size_t most) const;

 private:
  using Message = std::shared_ptr<const std::string>;
  struct Kept {
    Piece piece;  ///< without its content
    Message message;
  };
  static std::size_t sizeOf(const Kept& kept);
  void keep(Piece piece);
  void trim();
  void clear();

  const double seconds_;
  const std::size_t bytes_;
  PieceBuilder builder_;
  std::deque<Kept> pieces_;                  ///< complete ones
  Message growing_;                          ///< the piece that grows, compressed; nullptr if it grew since
  std::map<std::uint32_t, Message> scenes_;  ///< by shape
  std::size_t used_ = 0;                     ///< bytes of complete pieces, and of scenes
};

}  // namespace spark::web
