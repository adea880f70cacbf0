#pragma once
/// \file
/// Connections to running simulations.

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sparkctl {

using Json = nlohmann::ordered_json;

/// Paths of the control sockets of this user's running simulations, sorted. Folders that another user could have
/// created or changed are skipped; for each of these a sentence is added to `skipped`.
std::vector<std::string> findSockets(std::vector<std::string>& skipped);

/// True for text that a request can contain.
bool isUtf8(const std::string& text);

/// A connection to the control server of a simulation. Functions throw std::runtime_error, with one sentence, if it
/// does not answer in time, has ended or returns an error.
class ControlConnection {
 public:
  /// Connects to a socket. `timeout`: for each answer [s]. Also throws if the program behind the socket runs as another
  /// user.
  ControlConnection(const std::string& socket, double timeout);
  ~ControlConnection();
  ControlConnection(const ControlConnection&) = delete;
  ControlConnection& operator=(const ControlConnection&) = delete;
  /// Sends a request and returns the answer.
  Json ask(const Json& request);
  /// Returns the next line of a watch; waits without a timeout.
  Json next();

 private:
  using Clock = std::chrono::steady_clock;
  void wait(short events, Clock::time_point until);
  Json receive(Clock::time_point until);
  Clock::time_point deadline() const;

  std::string name_;      ///< path of the socket
  std::string received_;  ///< bytes after the last line that was returned
  double timeout_;
  int socket_ = -1;
};

}  // namespace sparkctl
