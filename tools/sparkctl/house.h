#pragma once
/// \file
/// A connection to a running house.

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sparkctl {

using Json = nlohmann::ordered_json;

/// The control sockets of this user's living houses, by name. Folders that others could have made are left out;
/// `refused` says why.
std::vector<std::string> houses(std::vector<std::string>& refused);

/// Speaks to one house. Functions throw std::runtime_error with one sentence when it does not answer.
class House {
 public:
  /// `timeout`: for each answer [s]. Throws also for a program of another user.
  House(const std::string& socket, double timeout);
  ~House();
  House(const House&) = delete;
  House& operator=(const House&) = delete;
  /// Sends one request and waits for its answer. Throws what the house says when it refuses.
  Json ask(const Json& request);
  /// Waits for the next line of a watch, for as long as it takes.
  Json next();

 private:
  using Clock = std::chrono::steady_clock;
  void wait(short events, Clock::time_point until);
  Json receive(Clock::time_point until);
  Clock::time_point deadline() const;

  std::string name_, received_;
  double timeout_;
  int socket_ = -1;
};

}  // namespace sparkctl
