#pragma once
/// \file
/// How an agent's scene files come into the tree: only with the consent of the rules.

#include <string>

#include "api/agents.h"

namespace spark::gamecontrol {

/// Imports `file` below `parent`, which is the agent's aspect or below it, unless a judge refuses the file or a
/// perceptor or an effector that it brings (IAgentJudge::judgeRequest). Returns "", or why it is refused. Throws Error
/// if it cannot be imported. What was imported is removed then, in both cases. Judges may be scripts, which remove
/// anything.
std::string importJudged(AgentAspect& agent, Node& parent, const std::string& file, const List& arguments);

}  // namespace spark::gamecontrol
