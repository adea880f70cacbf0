#pragma once
/// \file
/// The processes that mpirun started together. Without mpirun there is one, and MPI is never touched.

#include <memory>
#include <optional>
#include <string>

namespace sparkbatch {

/// What processes say to each other.
enum class Word {
  ready,  ///< a helper has an idle thread
  run,    ///< the leader's answer: the number of a run; empty: there are no more
  row,    ///< a helper's result
  bye,    ///< a helper is done; says what it used
  home,   ///< the leader: all are done
};

struct Message {
  int from;
  Word word;
  std::string text;
};

/// One of the processes; number 0 leads. To be used by the main thread alone.
class Cluster {
 public:
  virtual ~Cluster() = default;
  /// True when mpirun (or another program of its kind) started this process as one of several.
  static bool started();
  /// Joins the others when there are some. Throws spark::Error when there are and this program was built without MPI.
  static std::unique_ptr<Cluster> join();

  virtual int number() const { return 0; }
  virtual int size() const { return 1; }
  /// Processes on this machine.
  virtual int neighbours() const { return 1; }
  virtual void send(int /*to*/, Word /*word*/, const std::string& /*text*/) {}
  /// The next message, if one has come. Does not wait.
  virtual std::optional<Message> receive() { return std::nullopt; }
  /// Ends all processes when one cannot go on.
  virtual void abort(int /*code*/) {}
};

}  // namespace sparkbatch
