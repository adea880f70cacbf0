#pragma once

#include "api/match.h"

namespace spark::soccer {

/// Predicate of the action by which an agent joins a team.
inline constexpr std::string_view kInit = "init";

/// Reads `(init (unum 7)(teamname A))`; a missing number is 0, a missing name "". The name is a view into `action`.
inline IJoinPolicy::Name readInit(const Element& action) {
  const Element unum = action.named("unum"), team = action.named("teamname");
  return {team ? team.at(1).text() : std::string_view(), unum ? unum.at(1).integer() : 0};
}

/// What is wrong in an init action that readInit() reads all the same; "" if nothing is.
inline std::string remarkOnInit(const Element& action) {
  for (const Element e : action) {
    if (e.index() == (*action.begin()).index()) continue;
    const std::string_view name = e.isList() ? e.head() : e.text();
    if (!e.isList() || (name != "unum" && name != "teamname"))
      return fmt::format("expected (unum n) and (teamname t), found '{}', which is ignored", name);
    if (e.size() != 2) return fmt::format("expected one word after '{}', found {}", name, e.size() - 1);
  }
  const Element unum = action.named("unum");
  if (unum && !unum.at(1).isNumber())
    return fmt::format("expected a number as unum, found '{}', which counts as {}", unum.at(1).text(),
                       unum.at(1).integer());
  return {};
}

}  // namespace spark::soccer
