#include "gamecontrol/script_perceptor.h"

#include <fmt/format.h>

#include <utility>

#include "gamecontrol/script_event.h"

namespace spark {

namespace {
constexpr std::string_view kPerceive = "perceive";
constexpr std::int64_t kMost = 65536;  // bytes of a percept, with 8 for each number and list

/// Subtracts the size of a value from `left` [bytes], until that is negative.
void spend(const Value& value, std::int64_t& left) {
  left -= value.isString() ? static_cast<std::int64_t>(value.toString().size()) + 1 : 8;
  if (!value.isList()) return;
  for (const Value& v : value.toList())
    if (left >= 0) spend(v, left);
}

/// whyUnwritable(), but any text can be sent: it is quoted if it is no word.
std::string whyNoPercept(const Value& value) {
  if (value.isString()) return {};
  if (!value.isList()) return whyUnwritable(value);
  for (const Value& v : value.toList())
    if (std::string why = whyNoPercept(v); !why.empty()) return why;
  return {};
}

/// "", or why the percept cannot be sent.
std::string whyNot(const Value& percept) {
  std::int64_t left = kMost;
  spend(percept, left);
  return left < 0 ? fmt::format("expected at most {} bytes, found more", kMost) : whyNoPercept(percept);
}
}  // namespace

void ScriptPerceptor::describe(Description<ScriptPerceptor>& d) {
  d.doc("A perceptor written in Lua: its handler of perceive returns the percept.");
  d.implements<ISharedView>();
  d.link(&ScriptPerceptor::simulation_, At<ISimulation>()).doc("The clock of its events.");
  d.method("script", &ScriptPerceptor::script)
      .parameters({"file", "arguments"})
      .optional(1)
      .doc("Attaches the script, which reads the arguments as `local args = ...`.");
}

void ScriptPerceptor::onLink() {
  kernel().events().define(kPerceive, Order::parentsFirst, "At a ScriptPerceptor: returns its percept.");
}

void ScriptPerceptor::script(const std::string& file, const Value& arguments) {
  gamecontrol::attachScript(*this, file, arguments);
}

void ScriptPerceptor::share(std::uint64_t round) {
  if (std::exchange(round_, round) == round) return;
  percept_ = {};
  const Ref<ScriptPerceptor> self(this);
  Value answer;  // of the last handler that has one
  for (Value& one : gamecontrol::askScripts(*this, kPerceive, gamecontrol::eventNow(simulation_.get())))
    if (!one.isNil()) answer = std::move(one);
  if (!self || answer.isNil()) return;
  if (const std::string why = whyNot(answer); why.empty())
    percept_ = std::move(answer);
  else
    refuse(why);
}

void ScriptPerceptor::refuse(const std::string& why) {
  kernel().countFault();
  if (!std::exchange(isRefused_, true))
    kernel().log().error("{}: its script returned a percept that cannot be sent: {}. This is logged once.", path(),
                         why);
}

void ScriptPerceptor::sense(Predicates& out, const Event&) {
  if (percept_.isNil()) return;
  out.open(predicateName().empty() ? messageName() : predicateName());
  if (percept_.isList())
    append(percept_.toList(), out);
  else
    append(List{percept_}, out);
  out.close();
}

}  // namespace spark
