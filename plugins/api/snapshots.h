#pragma once
/// \file
/// A simulation between two cycles, as a whole: to go back to it, or to go on from it in another program.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "spark/abi/api/snapshots.h"
#include "spark/channel_name.h"
#include "spark/interface.h"

namespace spark {

/// Channel of an event behind each restored snapshot, before anything else happens: nodes that have restored their
/// loaded state only in part restore the rest. Defined by Snapshots.
inline constexpr ChannelName kRestored{"restored"};

/// What the run has added to the tree, and all settings; opaque.
class TreeShape;

/// A simulation between two cycles. It may be kept and copied, and outlive the kernel.
struct Snapshot {
  std::int64_t cycle = 0;
  std::uint64_t structure = 0;             ///< Kernel::structureVersion()
  std::shared_ptr<const TreeShape> shape;  ///< nullptr: the state alone
  std::string state;                       ///< saveTree() of the root
};

/// Takes snapshots and restores them, at /sys/host/snapshots. Between two cycles, simulation thread.
class ISnapshots {
 public:
  SPARK_INTERFACE(ISnapshots, 1);
  static constexpr const char* kPath = "/sys/host/snapshots";
  virtual ~ISnapshots() = default;
  /// Takes one; the memory of `out` is used again. `whole` false: only to go back within this run while it has the same
  /// objects, such as for learning.
  virtual void take(Snapshot& out, bool whole = true) = 0;
  /// Goes back within a run, or goes on from a run that was built in the same way. If the objects of a snapshot of this
  /// run are all there, the state is restored and settings stay. Otherwise objects that were made since are removed,
  /// those that are missing are made again in the order of then, and settings get their values of then. Throws Error if
  /// the tree cannot be made the same; it is then somewhere in between.
  /// `seed`: of a branch, whose random streams go other ways than those of the run, which has another seed.
  virtual void restore(const Snapshot& snapshot, std::optional<std::uint64_t> seed = {}) = 0;
  /// Goes on from the newest state of a file that is not later than `seconds`. Throws Error if it has none, and as
  /// restore().
  virtual void load(const std::string& file, double seconds, std::optional<std::uint64_t> seed = {}) = 0;
  /// A whole snapshot as bytes.
  virtual std::string write(const Snapshot& snapshot) const = 0;
  /// What write() wrote. Throws Error for anything else.
  virtual Snapshot read(std::string_view bytes) const = 0;
};

}  // namespace spark
