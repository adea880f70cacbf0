#pragma once
/// \file
/// Runs templates in Lua.

#include "request.h"

namespace spark::templates {

/// Runs the program of a template in a Lua state of its own. A failure is in the reply.
void runLua(const Request& request, Reply& reply);

}  // namespace spark::templates
