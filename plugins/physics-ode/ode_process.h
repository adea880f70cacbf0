#pragma once
/// \file
/// ODE's state per process and per thread, shared by all engines of a process: initialisation, message handlers, locks.

#include <mutex>
#include <string>

namespace spark::ode {

/// Keeps ODE initialised while an object of this class exists, in any thread.
class LibraryGuard {
 public:
  LibraryGuard();
  ~LibraryGuard();
  LibraryGuard(const LibraryGuard&) = delete;
  LibraryGuard& operator=(const LibraryGuard&) = delete;
};

/// While it exists, messages from ODE in this thread (errors, assertions, warnings) are written to a string, and ODE
/// neither ends the process nor prints. The constructor allocates ODE's data for this thread where needed.
class MessageCapture {
 public:
  /// `text` receives the last message; it must outlive the capture. Captures may be nested: the innermost receives.
  explicit MessageCapture(std::string& text);
  ~MessageCapture();
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

 private:
  std::string* previous_;
};

/// Lock for collisions with triangle meshes: Debian's ODE has one set of mesh caches per process.
std::mutex& meshMutex();

/// Lock for the iterative solver: ODE has one random seed per process, which is set before each run.
std::mutex& quickStepMutex();

}  // namespace spark::ode
