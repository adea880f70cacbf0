#pragma once
/// \file
/// Records a run.

#include <atomic>
#include <memory>
#include <set>
#include <string>

#include "api/inputs.h"
#include "api/phases.h"
#include "api/snapshots.h"
#include "frames.h"
#include "input_codec.h"
#include "match_channels.h"
#include "recording.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/sources.h"

namespace spark {

/// Writes the tape of a run to a file: inputs, hashes of the state, the whole state from time to time, and the texts
/// that the run was made of. At /sys/host/tape. It has no state, and nothing in the simulation depends on it.
class Recorder : public Node, public IInputTape {
  SPARK_CLASS(Recorder, Node)
 public:
  static void describe(Description<Recorder>& d);
  ~Recorder() override;

  bool playing() const override { return false; }
  bool put(const Input& input) override;
  Clock::time_point time(Clock::time_point live) override;
  bool decide(std::string_view what, std::uint64_t key, bool live, bool usual) override;

  /// Begins a recording; the present state is its first. `arguments`: of the program. Throws Error if the file cannot
  /// be written, or if it records already.
  void record(std::string file, const std::vector<std::string>& arguments);
  /// Writes the rest and the end.
  void finish();
  /// Ends it and removes its file again, if record() made that: there was no run.
  void discard();

 protected:
  void onUnlink() override;

 private:
  void beforePublish(const Event&) { structure_ = kernel().structureVersion(); }
  void endCycle(const Event& event);
  std::string withoutSecrets(std::string_view request) const;
  void writeInputs(mcap::Time time);
  void keyFrame(mcap::Time time);
  void attachNewTexts(mcap::Time time);
  void drawFrame(mcap::Time time);
  void note(Level level, std::string_view line);

  std::unique_ptr<recorder::Recording> recording_;
  recorder::InputBatch inputs_;                         ///< since the last cycle
  std::shared_ptr<recorder::InputWriter> inputWriter_;  ///< thread of the recording
  bool inputsRestart_ = false;
  std::uint16_t inputChannel_ = 0, stateChannel_ = 0, hashChannel_ = 0, logChannel_ = 0, shapeChannel_ = 0,
                placeChannel_ = 0;
  int logSink_ = 0;
  std::set<Sources::Source> attached_;  ///< texts that are in the recording, or are not to be had
  std::string file_;
  std::unique_ptr<recorder::Frames> frames_;
  std::unique_ptr<recorder::MatchChannels> match_;
  std::uint64_t structure_ = 0;      ///< version of the tree before the frame of the monitor server was made
  double every_ = 10, picture_ = 1;  ///< s between key frames, and between places of shapes
  double framesPerSecond_ = 12.5;    ///< of the match as browsers show it
  int hashEvery_ = 10;
  double nextPicture_ = 0;
  double nextKeyFrame_ = 0;
  std::atomic<mcap::Time> lastTime_ = 0;  ///< the log may be written by any thread
  bool failed_ = false;
  std::int64_t stateCycle_ = -1;  ///< of the last key frame
  std::size_t stateBytes_ = 0;    ///< of its state
  Link<ISimulation> simulation_;
  Link<ISnapshots> snapshots_;
  Link<IMonitorServer> monitor_;
};

}  // namespace spark
