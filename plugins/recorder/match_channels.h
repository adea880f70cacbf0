#pragma once
/// \file
/// The match as browsers show it, for the page of monitor-web, which plays recordings.
///
///     simulation thread                               thread of the recording
///     MatchChannels::take, in the publish phase ────► MatchWriter: scenes, pieces of two seconds ─► chunks
///           copies a frame when one is due
///
/// Messages are those of the web server's history, in the encoding of plugins/monitor-web/README.md, except that they
/// are not compressed: the chunks are.

#include <memory>
#include <string>

#include "api/monitor.h"
#include "recording.h"
#include "stream/messages.h"
#include "stream/piece_builder.h"

namespace spark::recorder {

inline constexpr std::string_view kPieces = "/monitor", kScenes = "/monitor/scenes", kOutline = "/monitor/outline",
                                  kEvents = "/events";
inline constexpr std::string_view kMatchEncoding = "spark-monitor-2";

/// Writes scenes and pieces. Thread of the recording.
class MatchWriter {
 public:
  struct Channels {
    std::uint16_t pieces = 0, scenes = 0, outline = 0, events = 0;
  };
  /// `interval`: simulated time between two frames [s].
  MatchWriter(Channels channels, double interval) : channels_(channels), builder_(interval) {}
  /// `snapshot.scene` is set if its shape is another one than before.
  void take(const web::Snapshot& snapshot, mcap::Time time, const Recording::Put& put);
  /// Writes the piece that grows, and all changes and events as a JSON list, so that a reader need not read everything
  /// for its timeline.
  void finish(mcap::Time time, const Recording::Put& put);

 private:
  void write(const web::Piece& piece, mcap::Time time, const Recording::Put& put);
  const Channels channels_;
  web::PieceBuilder builder_;
  web::FrameScene scene_;
  web::ChangeTracker changes_;  ///< of the environment, for the channel of events
  std::uint64_t shape_ = 0;     ///< Snapshot::shape of the last scene
  std::uint32_t number_ = 0;    ///< its number, from 1
  std::string outline_;         ///< of the pieces that are written
};

/// Copies frames of the monitor server. Simulation thread.
class MatchChannels {
 public:
  /// Adds the channels. `recording` must outlive this object. `frames`: number in a simulated second.
  MatchChannels(Recording& recording, double frames);
  /// Takes the events of the frame of this cycle, and the frame if one is due. Publish phase, after the
  /// server. `seconds`: simulated time.
  /// `describe`: objects of the frame exist, so that its scene may be described if it is a new one.
  void take(const IMonitorServer& server, std::int64_t cycle, double seconds, bool describe);
  void finish(mcap::Time time);

 private:
  Recording& recording_;
  const double interval_;  ///< s
  std::shared_ptr<MatchWriter> writer_;
  Predicates events_;  ///< since the last frame that was taken
  std::vector<double> eventTimes_;
  std::uint64_t serial_ = 0, shape_ = 0;  ///< of the last frame; of the last scene
  double last_, sceneAt_;                 ///< s, time of the last frame and of the last scene
};

}  // namespace spark::recorder
