#pragma once
/// \file
/// Requests of sparkctl and other clients: JSON in, JSON out, answered from the descriptions of classes.
///
///     {"do":"tree","path":"/sys","depth":2}         {"ok":true,"tree":{"name","class","doc","children":[...]}};
///                                                   "more": number of children omitted because of depth or number;
///                                                   with "links":true also "links":[{"to","paths"}, ...]
///     {"do":"get","path":"/x","property":"step"}    {"ok":true,"properties":[{"name","value","text","type",...}]}
///     {"do":"get","path":"/x"}                      all properties of the node
///     {"do":"set","path","property","value"}        as get, after the change
///     {"do":"call","path","method","arguments":[]}  {"ok":true,"text","value"}
///     {"do":"make","path","class"}                  {"ok":true,"text"}: makes a node; the text is its path
///     {"do":"attach","path","text","name"}          {"ok":true,"text","value","values"}: runs a script at a node,
///                                                   see lua/README.md; the values are its results, the first one
///                                                   alone is "value", and "text" has a line for each
///     {"do":"watch","path","property"}              {"ok":true,"cycle","time","text","value"}, now and after changes
///     {"do":"load","name":"wind"}                   {"ok":true,"text"}: loads a plugin and registers its classes
///     {"do":"unload","name":"wind"}                 {"ok":true}
///     {"do":"plugins"}                              {"ok":true,"plugins":[{"name","version","doc","file",...}]}
///
/// and the requests of the control server's children (IRequestHandler).
///
/// Strings in "value" and "arguments" are parsed like user input (true, 3, {1,2}, words). Errors:
/// {"ok":false,"error":"..."}.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "api/control.h"
#include "spark/class_object.h"
#include "spark/kernel.h"

namespace spark::control {

/// The answer to a request of one line, both without the line feed. An invalid request gets an error answer; does not
/// throw. `self`: the server's node; requests that would remove it are refused. A watch request sets `watch`, and the
/// answer is its first line. `mayChange` false: requests that change something are refused. Simulation thread, between
/// cycles.
std::string answer(Kernel& kernel, const Node& self, std::string_view line, Watch& watch, bool mayChange = true);

/// The next line of a watch; "" if the value has not changed. If the property is gone, an error answer, and `done` is
/// set.
std::string nextOf(Kernel& kernel, Watch& watch, bool& done);

}  // namespace spark::control
