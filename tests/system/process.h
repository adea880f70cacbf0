#pragma once
/// \file
/// Programs of this build as child processes: their output and exit codes.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "patience.h"

namespace spark::test {

/// A child process. Its stdout is read line by line, its stderr is kept. The destructor kills it. Functions throw
/// std::runtime_error, with the stderr output of the program, when a wait takes longer than kPatience.
class Process {
 public:
  /// Starts `command` (program and arguments).
  explicit Process(const std::vector<std::string>& command);
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
  /// Stops the process and returns when it has stopped; SIGCONT continues it.
  void halt();
  int pid() const { return pid_; }
  /// Its output on stderr so far.
  std::string errors() const;
  /// Waits until stderr contains `text`.
  void waitForError(const std::string& text);

 private:
  bool fill();
  [[noreturn]] void tooLong(const std::string& what);

  std::string name_, buffer_;
  std::filesystem::path errorFile_;
  int pid_ = -1, out_ = -1, status_ = 0;
  bool ended_ = false;
};

/// Runs a program to its end.
struct Finished {
  int code;
  std::string out, errors;
};
Finished runToEnd(const std::vector<std::string>& command);

/// Appends words to a command line.
std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more);

/// Arguments for a sparkhost with agents that switch off its wall-clock limits. Later arguments override them.
std::vector<std::string> withoutLimits();

/// Arguments for sparkctl with a timeout of kPatience; the command follows them.
std::vector<std::string> sparkctl(int pid);

/// The content of a file; "" if it does not exist.
std::string textOf(const std::filesystem::path& file);

}  // namespace spark::test
