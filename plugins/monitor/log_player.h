#pragma once
/// \file
/// Plays logs to monitors.

#include <memory>
#include <optional>

#include "api/command_check.h"
#include "api/drawing.h"
#include "frame_source.h"
#include "log_file.h"
#include "recorded_scene.h"
#include "snapshot_cache.h"
#include "spark/describe.h"
#include "spark/node.h"

namespace spark {

/// Plays a log to all monitors of the server above it. As in a live game, each monitor gets what has changed since its
/// own last message, so monitors may connect at any time, and the game can be paused, stepped and played backwards.
///
/// Trainer commands, named after the keys of SimSpark's log player: `(p)` pause or continue, `(f)` and `(b)` one record
/// forward or back, `(l)` reverse the direction, `(speed 2)`, `(record 150)`, `(time 30)`. Recorded drawings are
/// drawn by the simulation's IDrawings, if there is one.
///
/// A file is text, one message a line, unless a child recognises it (IGameLog).
///
/// A seek far away is split over several frames. Commands only set its target: however many come in a cycle, one seek
/// follows.
class LogPlayer : public Node, public IFrameSource, public ITrainer, public ICommandCheck {
  SPARK_CLASS(LogPlayer, Node)
 public:
  static void describe(Description<LogPlayer>& d);

  bool fill(MonitorFrame& frame, std::vector<std::uint64_t>& ids, const Event& event, bool watched) override;
  bool command(const Element& command, std::string& why) override;
  std::string check(const Element& command) override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  std::vector<std::string> commands() const { return {"p", "f", "b", "l", "speed", "record", "time"}; }
  std::string file() const { return path_; }
  /// Opens a log and shows the current record of it. Throws Error if it cannot be played.
  void setFile(std::string path);
  std::int64_t record() const { return target_.value_or(static_cast<std::int64_t>(at_)); }
  std::int64_t records() const { return log() ? static_cast<std::int64_t>(log()->size()) : 0; }
  double time() const;
  void setTime(double seconds);
  std::size_t recordAt(double seconds) const;
  /// Shows a record at once; a number beyond the end means the last one.
  void setRecord(std::int64_t record);
  void setTarget(std::int64_t record);
  void seekTarget();
  bool advance(std::size_t records);
  bool step();
  void seek(std::size_t target);
  void beginSeek(std::size_t target);
  bool continueSeek(std::size_t target, std::size_t maxRecords);
  void apply(std::size_t record);
  void draw(std::size_t record);
  void clearDrawings();

  /// What is played; nullptr: nothing.
  IGameLog* log() const;

  std::string path_;
  double recordTime_ = 0.2, speed_ = 1;
  bool paused_ = false, backward_ = false, waitForMonitor_ = true;

  std::unique_ptr<LogFile> text_;  ///< what is played if it is text
  Ref<Leaf> format_;               ///< the child that reads what is played if it is not
  Links<IGameLog> formats_;
  RecordedScene scene_{*this};
  std::size_t at_ = 0;  ///< the record that was applied last
  log_player::SnapshotCache snapshots_;
  std::optional<std::int64_t> target_;  ///< record that commands have requested
  bool seeking_ = false;                ///< a seek to `target_` has begun and continues in the next frame
  double due_ = 0;                      ///< records that are due since `at_`; a fraction while playing
  double lastTime_ = 0;                 ///< s, simulated, of the last frame
  bool started_ = false;                ///< playing has begun, see waitForMonitor
  bool sendEvents_ = false;             ///< the next frame has the events of record `at_`
  std::uint64_t shownShape_ = 0;        ///< RecordedScene::shape() of the last frame
  std::int64_t damaged_ = 0;            ///< number of records that could not be applied
};

}  // namespace spark
