#pragma once
/// \file
/// What comes from outside of a simulation, as one tape: messages and connections, requests and commands, and the wall
/// clock where it decides something. A recorder writes the tape; a player gives it back, and the same simulation
/// follows.
///
/// Code that passes something from outside to the simulation calls put() first, in the simulation's thread. Code that
/// decides by the wall clock, or by what a client has read, asks the tape.

#include <chrono>
#include <cstdint>
#include <string_view>

#include "spark/abi/api/inputs.h"
#include "spark/node.h"

namespace spark {

class IConnection;

/// One thing that came from outside.
struct Input {
  enum class Kind : std::uint8_t {
    cycle,     ///< no input: the cycle `number` begins
    time,      ///< the wall clock was read: `number` [us], from an arbitrary zero
    connect,   ///< a client connected to the port at `place`; `text`: its address
    message,   ///< a message from it, without framing
    leave,     ///< it disconnected, or was closed
    request,   ///< a request of the control protocol that may change something; `text`: its line
    command,   ///< a command to the monitor server; `place`: of whom
    decision,  ///< a decision was the less usual one; `place`: which
  };
  Kind kind = Kind::cycle;
  std::string_view place = {};  ///< a path or a name
  std::uint64_t key = 0;        ///< of the connection at its port; of whom is decided
  std::int64_t number = 0;
  std::string_view text = {};
};

/// The tape, at /sys/host/tape: what is there is no part of the simulation. Simulation thread.
class IInputTape {
 public:
  SPARK_INTERFACE(IInputTape, 1);
  static constexpr const char* kPath = "/sys/host/tape";
  using Clock = std::chrono::steady_clock;
  virtual ~IInputTape() = default;
  /// True if the tape is played: inputs come from it, and nothing waits for the wall clock.
  virtual bool playing() const = 0;
  /// Something came from outside. `input` is valid during the call. False: the tape is played and this is none of its
  /// inputs, so it must not change anything.
  virtual bool put(const Input& input) = 0;
  /// Playing: passes the inputs to their receivers that came before the next decision or cycle. At the end of the tape
  /// it stops the simulation.
  virtual void play() {}
  /// Playing, when a state is loaded: the client that was connected to a port when it was saved; valid until it is
  /// disconnected. nullptr: there is none.
  virtual IConnection* connection(Node& port, std::uint64_t key) {
    (void)port, (void)key;
    return nullptr;
  }
  /// The wall clock for a decision: `live`, or what it was when the tape was recorded.
  virtual Clock::time_point time(Clock::time_point live) = 0;
  /// The outcome of a decision about `key` that depends on the machine or on the network: `live`, or what it was when
  /// the tape was recorded. `usual` is the outcome that is not written down.
  virtual bool decide(std::string_view what, std::uint64_t key, bool live, bool usual) = 0;
};

}  // namespace spark
