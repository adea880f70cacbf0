#pragma once

#include <memory>
#include <optional>

#include "api/drawing.h"
#include "frame_source.h"
#include "log_file.h"
#include "moments.h"
#include "recorded_scene.h"
#include "spark/describe.h"
#include "spark/node.h"

namespace spark {

/// Plays a recorded game to all monitors of the server above it. Each gets what it lacks, as in a live game, so
/// monitors come and go, and the game can be stopped, stepped and played backwards while they watch.
///
/// Trainer commands, named after the keys of the old log player: `(p)` pause or go on, `(f)` and `(b)` one record
/// forward or back,
/// `(l)` the other direction, `(speed 2)`, `(record 150)`. What was drawn goes to the house's drawings, if it has any.
class LogPlayer : public Node, public IFrameSource, public ITrainer {
  SPARK_CLASS(LogPlayer, Node)
 public:
  static void describe(Description<LogPlayer>& d);

  bool fill(MonitorFrame& frame, std::vector<std::uint64_t>& ids, const Event& event, bool watched) override;
  bool command(const Element& command, std::string& why) override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  std::vector<std::string> commands() const { return {"p", "f", "b", "l", "speed", "record"}; }
  std::string file() const { return path_; }
  /// Opens it. Throws Error when it cannot be played.
  void setFile(std::string path);
  std::int64_t record() const { return wanted_.value_or(static_cast<std::int64_t>(at_)); }
  std::int64_t records() const { return log_ ? static_cast<std::int64_t>(log_->size()) : 0; }
  /// Shows a record; one beyond the end is the last.
  void setRecord(std::int64_t record);
  void aim(std::int64_t record);
  void goWhereAimed();
  bool advance(std::size_t records);
  /// One record on; false at the end.
  bool step();
  void goTo(std::size_t target);
  void begin(std::size_t target);
  bool go(std::size_t target, std::size_t most);
  void take(std::size_t record);
  void draw(std::size_t record);
  void takeDrawingsAway();

  std::string path_;
  double recordTime_ = 0.2, speed_ = 1;
  bool paused_ = false, backward_ = false, waitForMonitor_ = true;

  std::unique_ptr<LogFile> log_;
  RecordedScene scene_{*this};
  std::size_t at_ = 0;
  log_player::Moments moments_;
  bool underWay_ = false;               ///< to wanted_, which is too far for one frame
  std::optional<std::int64_t> wanted_;  ///< where commands want to be with the next frame
  double due_ = 0;                      ///< part of a record that has passed
  double lastTime_ = 0;
  bool started_ = false;  ///< a monitor came
  bool tellEvents_ = false;
  std::uint64_t shown_ = 0;
  std::int64_t damaged_ = 0;
};

}  // namespace spark
