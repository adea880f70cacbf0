#pragma once
/// \file
/// Snapshots of a run.

#include <string>
#include <vector>

#include "api/inputs.h"
#include "api/phases.h"
#include "api/snapshots.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

namespace recorder {
/// A whole snapshot as bytes, in any thread. Precondition: it has a shape.
std::string snapshotBytes(const Snapshot& snapshot);
}  // namespace recorder

/// Takes and restores snapshots, at /sys/host/snapshots. It is made after all that belongs to the config: what is newer
/// was made by the run.
class Snapshots : public Node, public ISnapshots {
  SPARK_CLASS(Snapshots, Node)
 public:
  static void describe(Description<Snapshots>& d);
  void take(Snapshot& out, bool whole) override;
  void restore(const Snapshot& snapshot, std::optional<std::uint64_t> seed) override;
  void load(const std::string& file, double seconds, std::optional<std::uint64_t> seed) override;
  std::string write(const Snapshot& snapshot) const override;
  Snapshot read(std::string_view bytes) const override;

  /// Writes a file with a snapshot of now, and the texts that the run was made of. `replace`: it may take the place of
  /// a file that exists. Throws Error if that fails; what exists then stays.
  void save(const std::string& file, bool replace);

 protected:
  void onLink() override;

 private:
  void loadFile(const std::string& file, double seconds) { load(file, seconds, {}); }
  std::vector<std::string> arguments_;
  Link<ISimulation> simulation_;
  Link<IInputTape> tape_;
};

}  // namespace spark
