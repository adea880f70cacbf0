#pragma once
/// \file
/// Cuts the stream into pieces of about two seconds, each of which is read without the others:
///
///     piece:   environment, key │ changes, delta │ changes, delta │ ... │ changes, delta
///     next:                                                               environment, key │ ...
///
/// The last frame of a piece is the first one of the next piece, so there is no gap between them. The web server keeps
/// the pieces of the last minutes for viewers, the recorder writes all of them. README.md specifies the bytes.

#include <optional>
#include <string>
#include <vector>

#include "messages.h"
#include "stream_encoder.h"

namespace spark::web {

/// What frames of a scene need to know of it.
class FrameScene {
 public:
  /// Begins a scene, which has a description.
  void begin(const Snapshot& snapshot);
  void update(const std::vector<std::uint8_t>& visible);
  /// The snapshot as input of an encoder. `shape`: number of the scene.
  Instant instant(const Snapshot& snapshot, std::uint32_t shape) const {
    return {shape, snapshot.time, snapshot.transforms, snapshot.visible, toggled_, mounts_};
  }

 private:
  std::vector<std::uint8_t> visible_;   ///< at the beginning
  std::vector<std::uint32_t> toggled_;  ///< nodes whose visibility has ever changed, in the order of their first change
  std::vector<Mount> mounts_;
};

/// Some seconds of a match.
struct Piece {
  double from = 0, to = 0;  ///< s, simulated, of the first and the last frame
  std::uint32_t shape = 0;  ///< number of its scene
  std::string environment;  ///< the whole one, at `from`
  /// Messages with changes and events, without `always` entries and sounds, each after a comma.
  std::string changes{};
  std::string content{};  ///< its records
};

/// How the content of a piece or a scene is packed.
enum class Packing : std::uint8_t { zstd, none };
/// The head of a binary message with a piece; its packed content follows. `complete`: no frame will be added to it.
std::string pieceHead(const Piece& piece, bool complete, Packing packing);
/// The head of a binary message with a scene; the scene message follows, packed.
std::string sceneHead(std::uint32_t shape, Packing packing);

/// Makes pieces of snapshots. One thread at a time.
class PieceBuilder {
 public:
  static constexpr double kInterval = 0.08;  ///< s, usual time between two frames
  /// `interval`: simulated time between two frames [s].
  explicit PieceBuilder(double interval = kInterval) : interval_(interval) {}

  /// Least simulated time from one frame to the next [s].
  double interval() const;
  /// Simulated time from which the next frame is wanted [s]; the lowest number if there is none yet.
  double due() const;
  /// Simulated time of the last frame [s]; the lowest number if there is none.
  double newest() const;
  /// The piece that grows; nullptr before the first frame.
  const Piece* growing() const { return growing_ ? &*growing_ : nullptr; }

  /// Takes the events of a snapshot. Those before the first frame are lost.
  void addEvents(const Snapshot& snapshot);
  /// Takes the frame of a snapshot, whose time must not be before newest(). Returns the piece that it completed.
  /// `shape`: number of its scene.
  std::optional<Piece> addFrame(const Snapshot& snapshot, std::uint32_t shape, const FrameScene& scene);
  /// Forgets the piece that grows.
  void clear() { growing_.reset(); }

 private:
  void begin(const Snapshot& snapshot, std::uint32_t shape);
  const double interval_;
  StreamEncoder encoder_{kFine};
  ChangeTracker environment_, changes_;  ///< with and without `always` entries
  std::optional<Piece> growing_;
};

}  // namespace spark::web
