#pragma once
/// \file
/// Programs of this build as child processes: their output and exit codes.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace spark::test {

/// A child process. Its stdout is read line by line, its stderr is kept in a file. The destructor kills it. Functions
/// throw std::runtime_error with the program's stderr when it exceeds the time limit.
class Process {
 public:
  /// Starts `command` (program and arguments). `limit`: the maximum time of every wait [s].
  explicit Process(const std::vector<std::string>& command, double limit = 240);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// The next line of stdout; throws at its end.
  std::string line();
  /// The remaining output on stdout.
  std::string rest();
  /// Waits for the end of the process; returns the exit code, or 128 + signal.
  int wait();
  void signal(int number);
  int pid() const { return pid_; }
  /// Its output on stderr so far.
  std::string errors() const;
  /// Waits until stderr holds `text`.
  void waitForError(const std::string& text);

 private:
  bool fill();
  [[noreturn]] void tooLong(const std::string& what);
  std::chrono::steady_clock::time_point deadline() const;

  std::string name_, buffer_;
  std::filesystem::path errorFile_;
  double limit_;
  int pid_ = -1, out_ = -1, status_ = 0;
  bool ended_ = false;
};

/// Runs a program to its end.
struct Finished {
  int code;
  std::string out, errors;
};
Finished runToEnd(const std::vector<std::string>& command);

/// The contents of a file; "" if it does not exist.
std::string textOf(const std::filesystem::path& file);

}  // namespace spark::test
