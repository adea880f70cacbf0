#pragma once
/// \file
/// What ODE keeps per process and per thread, shared by all engines of a process: initialisation, error handlers, the
/// lock of meshes.

#include <mutex>
#include <string>

namespace spark::ode {

/// Keeps ODE initialised while it lives. Any number of them, in any threads.
class ProcessUse {
 public:
  ProcessUse();
  ~ProcessUse();
  ProcessUse(const ProcessUse&) = delete;
  ProcessUse& operator=(const ProcessUse&) = delete;
};

/// While it lives, what ODE says in this thread (errors, assertions, messages) is appended to a text, and ODE neither
/// ends the process nor prints. Allocates ODE's data for this thread at first use.
class Listening {
 public:
  explicit Listening(std::string& text);
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

 private:
  std::string* before_;
};

/// Triangle meshes use caches that Debian's ODE has once per process: pairs with a mesh are collided under this lock.
std::mutex& meshMutex();

/// The iterative solver shuffles with a random seed that ODE has once per process: it is set and used under this lock.
std::mutex& quickMutex();

}  // namespace spark::ode
