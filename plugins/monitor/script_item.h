#pragma once
/// \file
/// What a script says to monitors: a game in Lua has its score on the page.

#include <map>
#include <string>
#include <vector>

#include "api/monitor.h"

namespace spark {

/// A monitor item that a script fills. Its entries read and write like properties: `item.score_left = 3` adds
/// `(score_left 3)` to every full message, and to the next one whenever the value changed. Entries are state: a rule
/// that keeps its score here is restored with the world. Below the monitor server.
class ScriptItem : public Node, public IMonitorItem {
  SPARK_CLASS(ScriptItem, Node)
 public:
  static void describe(Description<ScriptItem>& d);
  void contribute(Environment& env) override;

 private:
  void set(std::string name, Value value);
  Value get(std::string name) const;
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
