#pragma once
/// \file
/// One house from the command line to the last line on stdout.

#include <filesystem>
#include <string>

#include "options.h"
#include "spark/kernel.h"

namespace sparkhost {

/// Builds a kernel as the options say, and runs it. Set-up functions throw spark::Error.
class Host {
 public:
  /// Finds plugin folders and the share relative to the running program, so that a tree can be moved.
  explicit Host(const Options& options);

  spark::Kernel& kernel() { return kernel_; }
  /// Runs the config: afterwards the house stands.
  void build();
  /// Opens the ports and returns the first line of stdout.
  std::string open();
  /// How late and how long cycles were, for people.
  std::string histogram();
  /// Runs until its end and returns the last line of stdout.
  std::string run();

 private:
  void scanPlugins();
  void tellScripts();

  const Options& options_;
  spark::Kernel kernel_;
  std::filesystem::path bin_, share_;
};

}  // namespace sparkhost
