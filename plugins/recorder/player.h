#pragma once
/// \file
/// Plays a recording: a simulation built in the same way follows it.

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "about.h"
#include "api/inputs.h"
#include "api/net.h"
#include "api/phases.h"
#include "api/snapshots.h"
#include "input_codec.h"
#include "mcap.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// The tape of a recorded run, at /sys/host/tape. It passes the recorded inputs to their consumers, returns the
/// recorded times and decisions, and compares the recorded hashes and states.
class InputPlayer : public Node, public IInputTape {
  SPARK_CLASS(InputPlayer, Node)
 public:
  static void describe(Description<InputPlayer>& d);
  InputPlayer();
  ~InputPlayer() override;

  bool playing() const override { return true; }
  bool put(const Input& input) override;
  Clock::time_point time(Clock::time_point live) override;
  bool decide(std::string_view what, std::uint64_t key, bool live, bool usual) override;
  void play() override;
  IConnection* connection(Node& port, std::uint64_t key) override;

  /// Opens a recording and compares the present state with its first one. Throws Error if it cannot be read.
  void open(std::string file);
  /// Goes to the newest recorded state that is not later than `seconds`. Between two cycles. Throws Error if there is
  /// none, or if the tree cannot be made so.
  void seek(double seconds);

 protected:
  void onUnlink() override;

 private:
  class Connection;
  void fill();
  bool readChunk();
  bool readPieces();
  bool skipHole();
  void goTo(recorder::StateAt at);
  const recorder::OwnInput* next();
  void pass(const recorder::OwnInput& input);
  IConnectionConsumer* consumerOf(const Leaf& port) const;
  void endCycle(const Event& event);
  void compareState(std::string_view frame);
  bool passInputs();
  mcap::Time timeNow() const;
  void differs(std::int64_t cycle, std::string what);
  void lost(std::string_view asked);
  std::vector<std::string> lacks() const;

  std::unique_ptr<mcap::Reader> reader_;
  std::size_t chunk_ = 0;           ///< next one to read
  mcap::Time after_ = -1;           ///< messages up to then belong to what was skipped
  bool hole_ = false;               ///< what follows inputs_ is damaged
  std::vector<std::string> holes_;  ///< what was left out, a sentence each
  recorder::InputReader inputReader_;
  std::deque<std::pair<mcap::Time, std::string>> pieces_;  ///< of inputs, read and not yet decoded
  std::deque<recorder::OwnInput> inputs_;                  ///< read and not yet passed
  int cyclesAhead_ = 0;                                    ///< beginnings of cycles in inputs_
  std::size_t unfinished_ = 0;                  ///< bytes of inputs that were decoded since the last such beginning
  std::map<std::int64_t, std::string> hashes_;  ///< by cycle: read and not yet compared
  std::map<mcap::Time, std::string> frames_;    ///< states, likewise
  std::map<std::pair<std::string, std::uint64_t>, std::unique_ptr<Connection>> connections_;
  bool passing_ = false, lost_ = false;
  int idlePlays_ = 0;      ///< calls of play() since something was taken from the tape
  std::int64_t from_ = 0;  ///< the cycle of the last state to which it went
  std::int64_t cycle_ = 0, cycles_ = 0, compared_ = 0, states_ = 0, differsAt_ = -1;
  std::string file_, difference_;
  Link<ISimulation> simulation_;
  Link<ISnapshots> snapshots_;
};

}  // namespace spark
