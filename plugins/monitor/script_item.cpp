#include "script_item.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/script.h"

namespace spark {

namespace {
void checkName(const std::string& name) {
  if (!isWord(name))
    throw RefusedValue("expected the name of an entry: one word without blanks, brackets and quotes, found \"" + name +
                       "\"");
}

/// Throws RefusedValue if monitors cannot read the value.
void checkValue(const Value& value) {
  if (const std::string why = whyUnwritable(value); !why.empty()) throw RefusedValue(why);
}

/// Entries that a status has under other names, or not at all.
constexpr std::string_view kMonitorWords[] = {"play_mode", "play_modes", "score_left", "score_right",
                                              "team_left", "team_right", "time"};

bool isStatusName(std::string_view name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  return std::all_of(name.begin(), name.end(), fits) &&
         std::find(std::begin(kMonitorWords), std::end(kMonitorWords), name) == std::end(kMonitorWords);
}

/// Adds `(name value)`, or `(name value value ...)` for a list.
void put(Environment& env, EnvPolicy policy, const std::string& name, const Value& value) {
  Predicates& out = env.open(policy, name);
  append(value.isList() ? value.toList() : List{value}, out);
  out.close();
}
}  // namespace

void ScriptItem::describe(Description<ScriptItem>& d) {
  d.doc("Entries for monitors that a script sets: item.score_left = 3 is the entry (score_left 3).");
  d.implements<IMonitorItem>();
  d.implements<IStatus>();
  d.method("set", &ScriptItem::set)
      .parameters({"name", "value"})
      .doc("Sets an entry: a number, a word, a bool, or a list of these; nil removes it.");
  d.method("get", &ScriptItem::get).parameters({"name"}).doc("An entry's value; nil if there is none.");
  d.property("names", &ScriptItem::names).doc("Names of all entries, sorted.");
  d.property("entries", &ScriptItem::entries, &ScriptItem::setEntries)
      .state()
      .doc("All entries at once: a table, or a list of {name, value}.");
  d.method("event", &ScriptItem::event)
      .parameters({"name", "values"})
      .doc("Sends an event once to every monitor, with the next frame: event(\"fell\", \"Red\", 3) is (fell Red 3).");
  d.method("script", &ScriptItem::script)
      .parameters({"file", "arguments"})
      .optional(1)
      .doc("Attaches the script, which reads the arguments as `local args = ...`.");
}

void ScriptItem::contribute(Environment& env) {
  // An entry 'time' replaces the server's own.
  for (const auto& [name, value] : entries_)
    put(env, name == "time" ? EnvPolicy::always : EnvPolicy::change, name, value);
  for (const Value& event : std::exchange(events_, {}))
    put(env, EnvPolicy::once, event.toList()[0].toString(), event.toList()[1]);
}

void ScriptItem::report(std::vector<StatusEntry>& out) const {
  if (const Value mode = playMode(); mode.isString()) out.push_back({"playMode", mode, {}});
  reportPair(out, "score", "score_left", "score_right");
  reportPair(out, "teams", "team_left", "team_right");
  for (const auto& [name, value] : entries_)
    if (isStatusName(name)) out.push_back({name, value, {}});
}

/// A mode's name, or its index in `play_modes`.
Value ScriptItem::playMode() const {
  Value mode = get("play_mode");
  const Value names = get("play_modes");
  if (!mode.isInteger() || !names.isList() || mode.toInteger() < 0) return mode;
  const Value* name = names.at(static_cast<std::size_t>(mode.toInteger()));
  return name ? *name : mode;
}

void ScriptItem::reportPair(std::vector<StatusEntry>& out, const char* name, const char* left,
                            const char* right) const {
  const Value a = get(left), b = get(right);
  if (!a.isNil() && !b.isNil()) out.push_back({name, List{a, b}, {"Left", "Right"}});
}

void ScriptItem::set(std::string name, Value value) {
  checkName(name);
  if (value.isNil()) return static_cast<void>(entries_.erase(name));
  checkValue(value);
  entries_.insert_or_assign(std::move(name), std::move(value));
}

Value ScriptItem::get(const std::string& name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? Value() : found->second;
}

std::vector<std::string> ScriptItem::names() const {
  std::vector<std::string> out;
  for (const auto& [name, value] : entries_) out.push_back(name);
  return out;
}

Value ScriptItem::entries() const {
  List out;
  for (const auto& [name, value] : entries_) out.push_back(List{name, value});
  return out;
}

void ScriptItem::setEntries(Value pairs) {
  std::map<std::string, Value, std::less<>> taken;
  if (!pairs.isList()) throw RefusedValue("expected a table of entries, found " + pairs.text());
  for (const Value& pair : pairs.toList()) {
    if (!pair.isList() || pair.toList().size() != 2 || !pair.toList()[0].isString())
      throw RefusedValue("expected {name, value}, found " + pair.text());
    checkName(pair.toList()[0].toString());
    checkValue(pair.toList()[1]);
    taken.insert_or_assign(pair.toList()[0].toString(), pair.toList()[1]);
  }
  entries_ = std::move(taken);
}

void ScriptItem::event(const std::string& name, const std::vector<Value>& values) {
  checkName(name);
  for (const Value& v : values) checkValue(v);
  events_.push_back(List{name, values});
}

void ScriptItem::script(const std::string& file, const Value& arguments) {
  require<IScriptServer>().attach(*this, file, arguments);
}

}  // namespace spark
