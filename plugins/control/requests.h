#pragma once
/// \file
/// What sparkctl and other clients may ask: JSON in, JSON out, answered from the tree's own descriptions.
///
///     {"do":"tree","path":"/sys","depth":2}         {"ok":true,"tree":{"name","class","doc","children":[...]}};
///                                                   "more": number of children left out, for depth or number;
///                                                   with "links":true also "links":[{"to","paths"}, ...]
///     {"do":"get","path":"/x","property":"step"}    {"ok":true,"properties":[{"name","value","text","type",...}]}
///     {"do":"get","path":"/x"}                      all properties of the node
///     {"do":"set","path","property","value"}        as get, after the change
///     {"do":"call","path","method","arguments":[]}  {"ok":true,"text","value"}
///     {"do":"watch","path","property"}              {"ok":true,"cycle","time","text","value"} now and after each
///     change
///     {"do":"load","name":"wind"}                   {"ok":true,"text"}: registers a plugin's classes, loads its file
///     first
///     {"do":"unload","name":"wind"}                 {"ok":true}
///     {"do":"plugins"} {"ok":true,"plugins":[{"name","version","doc","file","classes",...}]}
///     whatever the children of the control server answer (IRequestHandler)
///
/// Texts in "value" and "arguments" are read as people type them (true, 3, {1,2}, words). Errors:
/// {"ok":false,"error":"..."}.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "api/control.h"
#include "spark/class_object.h"
#include "spark/kernel.h"

namespace spark::control {

/// The answer to one line, without the line feed. Bad requests give an error answer; nothing is thrown. `self`: the
/// server's own node, which requests must not saw off. When the request is a watch, `watch` is filled in and the answer
/// is its first line. `mayChange` false refuses all that changes something.
std::string answer(Kernel& kernel, const Node& self, std::string_view line, Watch& watch, bool mayChange = true);

/// The next line of a watch, "" when the value is as before. An error answer when the property is gone (`done` is set).
std::string nextOf(Kernel& kernel, Watch& watch, bool& done);

}  // namespace spark::control
