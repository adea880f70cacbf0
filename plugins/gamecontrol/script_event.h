#pragma once
/// \file
/// Events at nodes whose scripts do the work.

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "api/phases.h"
#include "spark/kernel.h"
#include "spark/predicates.h"
#include "spark/script.h"

namespace spark::gamecontrol {

/// Emits the event `channel` at `node` only and returns what each of its scripts' handlers returned, in order, without
/// those that failed. The scripts may delete the node. Simulation thread.
inline List askScripts(Leaf& node, std::string_view channel, Event event, const Value* data = nullptr) {
  Value answers(List{});
  event.name = channel;
  event.data = data;
  event.answer = &answers;
  node.kernel().events().channel(channel).emitAt(node, event);
  return std::move(answers.toList());
}

/// What a script returned as the reason of a refusal, one line for the log or the agent; "" for nil: no refusal. Only a
/// text is a reason: what else it returned is the reason that it is wrong.
inline std::string reasonOf(const Value& answer) {
  constexpr std::size_t kMost = 1024;  // bytes
  if (answer.isNil()) return {};
  if (!answer.isString())
    return fmt::format("its script returned a {}: expected nothing, or a text", typeName(answer.type()));
  if (answer.toString().size() > kMost)
    return fmt::format("its script returned a reason of {} bytes: expected at most {}", answer.toString().size(),
                       kMost);
  return answer.toString();
}

/// The first reason among what scripts returned; "": there is none.
inline std::string reasonOf(const List& answers) {
  for (const Value& answer : answers)
    if (std::string why = reasonOf(answer); !why.empty()) return why;
  return {};
}

/// An event of the present cycle; of cycle 0 if there is no run loop.
inline Event eventNow(const ISimulation* simulation) {
  Event event;
  if (!simulation) return event;
  event.time = simulation->time();
  event.step = simulation->step();
  event.cycle = simulation->cycle();
  return event;
}

/// An action or a part of it as a value. Languages without types send numbers as words.
inline Value toValue(const Element& e) {
  if (e.isList()) {
    List out;
    for (const Element inner : e) out.push_back(toValue(inner));
    return out;
  }
  if (e.token().kind == Token::Kind::integer) return e.token().integer;
  const std::optional<double> number = e.token().quoted ? std::nullopt : e.asNumber();
  return number ? Value(*number) : Value(e.text());
}

/// Attaches a script file to `node`; its `...` is `arguments`. Throws Error if it cannot be loaded.
inline void attachScript(Leaf& node, const std::string& file, const Value& arguments) {
  node.require<IScriptServer>().attach(node, file, arguments);
}

}  // namespace spark::gamecontrol
