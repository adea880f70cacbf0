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

}  // namespace spark::soccer
