#pragma once
/// \file
/// Entries of the monitors' environment that a script sets, such as the score of a game in Lua.

#include <map>
#include <string>
#include <vector>

#include "api/monitor.h"
#include "api/status.h"

namespace spark {

/// A child of the monitor server. Lua reads and writes its entries like properties: `item.score_left = 3` adds
/// `(score_left 3)` to every full message, and to the next message after the value changed. Entries are state: a rule
/// that stores its score here is restored with the simulation. The host's status line and a batch's columns show them,
/// too.
class ScriptItem : public Node, public IMonitorItem, public IStatus {
  SPARK_CLASS(ScriptItem, Node)
 public:
  static void describe(Description<ScriptItem>& d);
  void contribute(Environment& env) override;
  /// Reports the entries under the names of a status: `play_mode`, `score_left` and `score_right`, `team_left` and
  /// `team_right` become playMode, score and teams; `play_modes` and `time` are not reported; others keep their names.
  void report(std::vector<StatusEntry>& out) const override;

 private:
  void set(std::string name, Value value);
  Value get(const std::string& name) const;
  Value playMode() const;
  /// Reports the entries `left` and `right` as one list, if both exist.
  void reportPair(std::vector<StatusEntry>& out, const char* name, const char* left, const char* right) const;
  std::vector<std::string> names() const;
  Value entries() const;
  /// Replaces all entries. Throws RefusedValue, without a change, if one is invalid.
  void setEntries(Value pairs);
  void event(const std::string& name, const std::vector<Value>& values);
  void script(const std::string& file, const Value& arguments);

  std::map<std::string, Value, std::less<>> entries_;
  /// Events of the next frame: lists of name and values. Not state, since a frame is also made when a monitor connects.
  List events_;
};

}  // namespace spark
