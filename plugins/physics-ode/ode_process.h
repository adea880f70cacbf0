#pragma once
/// \file
/// ODE's state per process and per thread, shared by all engines of a process: initialisation, message handlers, locks.

#include <mutex>
#include <string>

#include "spark/error.h"
#include "spark/node.h"

namespace spark::ode {

/// Keeps ODE initialised while an object of this class exists, in any thread.
class LibraryGuard {
 public:
  LibraryGuard();
  ~LibraryGuard();
  LibraryGuard(const LibraryGuard&) = delete;
  LibraryGuard& operator=(const LibraryGuard&) = delete;
};

/// Thrown out of ODE where it would end the process, at an error or a failed assertion, through ODE's own frames. What
/// it was at is lost: memory for the step until the next one, and its result.
struct Failure : Error {
  using Error::Error;
};

/// While it exists, warnings from ODE in this thread are written to a string, and it does not print. The constructor
/// allocates ODE's data for this thread where needed.
class MessageCapture {
 public:
  /// `text` receives the last message; it must outlive the capture. Captures may be nested: the innermost receives.
  /// `unsolvedThrows`: the direct solver's message that it did not solve an island is a Failure.
  explicit MessageCapture(std::string& text, bool unsolvedThrows = false);
  ~MessageCapture();
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

 private:
  std::string* previous_;
  bool threw_;  ///< likewise
};

/// The messages from ODE to one node, failures among them.
struct Messages {
  std::string last;        ///< the last one that was not reported yet; a MessageCapture writes it
  std::int64_t count = 0;  ///< of reported ones
  /// Logs the last message, if there is one, as from `node`: the 1st, 2nd, 4th, 8th ... time.
  void report(const Leaf& node);
  /// Logs a failure of the direct solver after which the iterative one was taken, likewise.
  void mend(const Leaf& node, const std::string& text);
  /// Logs a failure as an error, likewise. `what`: what it ended, and what becomes of it.
  void fail(const Leaf& node, const std::string& text, const std::string& what);

 private:
  bool isDue() { return ++count, (count & (count - 1)) == 0; }
};

/// Lock for collisions with triangle meshes: Debian's ODE has one set of mesh caches per process.
std::mutex& meshMutex();

/// Lock for the iterative solver: ODE has one random seed per process, which is set before each run.
std::mutex& quickStepMutex();

}  // namespace spark::ode
