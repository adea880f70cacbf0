#pragma once
/// \file
/// The status of a game: mode, score, teams and further values. The host's status line, the columns of a batch and the
/// page in browsers show it without knowing the game.

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/api/status.h"
#include "spark/kernel.h"
#include "spark/link.h"
#include "spark/node.h"
#include "spark/value.h"

namespace spark {

/// One value that a node reports.
struct StatusEntry {
  std::string name;                ///< a word of letters, digits and '_'
  Value value;                     ///< a text, number or boolean, or a list of these
  std::vector<std::string> parts;  ///< column suffixes of a list's elements; empty: 1, 2, ...
};

/// Reports the status of a game. Any node below /sys or /usr may offer it.
///
/// All displays know three names:
///
///     playMode   text              mode of the game: "PlayOn", "round_2"
///     score      list of numbers   points of each team; the page's score board shows the first two
///     teams      list of texts     names of the teams, in the order of the score
///
/// Every other entry is shown as `name value`. In a batch an entry is a column of that name; a list is one column for
/// each element, named `name` + suffix: `scoreLeft`, or `score1`.
class IStatus {
 public:
  SPARK_INTERFACE(IStatus, 1);
  virtual ~IStatus() = default;
  /// Appends the entries: the same names in the same order every time, so that all rows of a batch have the same
  /// columns. Called in the publish phase or between two cycles, in the simulation's thread. Must not throw.
  virtual void report(std::vector<StatusEntry>& out) const = 0;
};

/// True when `entry` has one of the three known names and a value of its type.
inline bool isStatusWord(const StatusEntry& entry) {
  if (entry.name == "playMode") return entry.value.isString();
  return (entry.name == "score" || entry.name == "teams") && entry.value.isList();
}

/// All nodes that offer IStatus, looked up again when the shape of the tree changed. A member of a class that displays
/// the status; used in the simulation's thread.
class StatusReporters {
 public:
  /// All entries, in tree order. Of entries with the same name only the first is kept.
  std::vector<StatusEntry> read(Kernel& kernel) {
    if (tree_.changed(kernel.root())) find(kernel);
    std::vector<StatusEntry> out;
    for (const IStatus* reporter : reporters_) reporter->report(out);
    for (std::size_t i = 1; i < out.size();)
      if (std::any_of(out.begin(), out.begin() + i, [&](const StatusEntry& e) { return e.name == out[i].name; }))
        out.erase(out.begin() + i);
      else
        ++i;
    return out;
  }

 private:
  void find(Kernel& kernel) {
    reporters_.clear();
    for (const char* path : {"/sys", "/usr"})
      if (const Node* top = kernel.root().find<Node>(path)) top->collect(reporters_);
  }
  TreeWatch tree_;
  std::vector<IStatus*> reporters_;
};

}  // namespace spark
