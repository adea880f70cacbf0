#pragma once
/// \file
/// Runs templates in Javascript.

#include "request.h"

namespace spark::templates {

/// Runs the program of a template in a global object of its own. A failure is in the reply.
void runJavascript(const Request& request, Reply& reply);

}  // namespace spark::templates
