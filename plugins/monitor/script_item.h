#pragma once
/// \file
/// Monitor entries that a script sets: a game in Lua shows its score on the page.

#include <map>
#include <string>
#include <vector>

#include "api/monitor.h"
#include "api/status.h"

namespace spark {

/// A monitor item that a script fills. Its entries read and write like properties: `item.score_left = 3` adds
/// `(score_left 3)` to every full message, and to the next one whenever the value changed. Entries are state: a rule
/// that keeps its score here is restored with the world. Below the monitor server. The host's status line and a batch's
/// columns have them as well.
class ScriptItem : public Node, public IMonitorItem, public IStatus {
  SPARK_CLASS(ScriptItem, Node)
 public:
  static void describe(Description<ScriptItem>& d);
  void contribute(Environment& env) override;
  /// The words of monitors in those of a status: `play_mode`, `score_left` and `score_right`, `team_left` and
  /// `team_right` become playMode, score and teams. All others but `play_modes` and `time` as they are.
  void report(std::vector<StatusEntry>& out) const override;

 private:
  void set(std::string name, Value value);
  Value get(std::string name) const;
  Value playMode() const;
  /// The entries `left` and `right` as one.
  void reportPair(std::vector<StatusEntry>& out, const char* name, const char* left, const char* right) const;
  std::vector<std::string> names() const;
  Value entries() const;
  /// Takes the place of all entries. Throws RefusedValue and changes nothing when one of them is none.
  void setEntries(Value pairs);
  void event(std::string name, std::vector<Value> values);
  void script(std::string file, Value arguments);

  std::map<std::string, Value, std::less<>> entries_;
  /// Events for the next frame. No state: frames are also made when a monitor connects.
  List events_;
};

}  // namespace spark
