#pragma once
/// \file
/// The processes that mpirun has started together. Without mpirun there is one, and MPI is not initialised.

#include <memory>
#include <optional>
#include <string>

namespace sparkbatch {

/// The kinds of messages between processes; see batch.cpp.
enum class MessageKind {
  ready,  ///< from a helper: it has an idle thread
  run,    ///< from the leader, the reply: number of a run; "": there are no more
  row,    ///< from a helper: a Row as JSON
  done,   ///< from a helper: it has finished; its Usage as JSON
  exit,   ///< from the leader: all helpers have finished
};

/// A received message.
struct Message {
  int from;  ///< number of the sender
  MessageKind kind;
  std::string text;
};

/// This process as one of several; number 0 leads. The base class is the one without mpirun. Main thread only.
class Cluster {
 public:
  virtual ~Cluster() = default;
  /// True if mpirun, or a similar program, has started this process as one of several.
  static bool started();
  /// Initialises MPI if started() is true. Throws spark::Error if this program was built without MPI then.
  static std::unique_ptr<Cluster> join();

  /// Number of this process, from 0.
  virtual int number() const { return 0; }
  /// Number of processes.
  virtual int size() const { return 1; }
  /// Number of processes on this machine, this one included.
  virtual int neighbours() const { return 1; }
  /// Sends a message to another process.
  virtual void send(int /*to*/, MessageKind /*kind*/, const std::string& /*text*/) {}
  /// The next message that has arrived, if any. Does not wait.
  virtual std::optional<Message> receive() { return std::nullopt; }
  /// Ends all processes, because this one cannot continue.
  virtual void abort(int /*code*/) {}
};

}  // namespace sparkbatch
