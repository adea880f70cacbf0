#pragma once
/// \file
/// Runs a simulation, from the command line to the last line on stdout.

#include <filesystem>
#include <string>

#include "options.h"
#include "spark/kernel.h"

namespace sparkhost {

/// Builds a kernel according to the options, and runs it. All functions throw spark::Error.
class Host {
 public:
  /// Plugin folders and shared files are found relative to the program, so that an installation can be moved. `options`
  /// must outlive it.
  explicit Host(const Options& options);

  /// The shared files of the program's installation.
  static std::filesystem::path installedShare();
  /// The kernel; owned by this object.
  spark::Kernel& kernel() { return kernel_; }
  /// Runs the config, which builds the simulation, then sets the properties of command line switches.
  void build();
  /// After build(): goes on from the state of options.from.
  void goOn();
  /// After goOn(): a sentence if the duration is over already; else "".
  std::string overAlready();
  /// Records to the file, from now on. Precondition: options.record.
  void record(const std::string& file);
  /// Removes the file of record() again, if it is new: there is no run.
  void discardRecording();
  /// Plays a recording from now on, instead of opening ports; the node that plays it. Precondition: options.replay.
  spark::Leaf& play(const std::string& file);
  /// Opens the ports and returns the first line of stdout.
  std::string open();
  /// A table of the delay and the duration of cycles, as text.
  std::string histogram();
  /// Runs the simulation to its end and returns the last line of stdout.
  std::string run();

 private:
  void scanPlugins();
  void mountFiles();
  void warnOfSecrets();
  std::vector<std::string> arguments();
  void defineHostTable();
  void applySwitches(std::size_t first);

  const Options& options_;
  spark::Kernel kernel_;
  std::filesystem::path bin_, share_;  ///< folders of the program and of lua/, scenes/, the viewer
};

}  // namespace sparkhost
