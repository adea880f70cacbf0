#pragma once
/// \file
/// Formats answers for the terminal.

#include <nlohmann/json.hpp>
#include <string>

namespace sparkctl {

using Json = nlohmann::ordered_json;

/// A tree with classes and a sentence each. Unless `all`, a run of more than a few siblings of one class is shortened.
/// `path`: of the top node.
std::string treeText(const Json& node, const std::string& path, bool all);
/// `name = value unit`, followed by type, range and documentation.
std::string propertyText(const Json& property);
/// JSON with a line for each member and for each element of a list.
std::string answerText(const Json& answer);
/// One line per plugin.
std::string pluginsText(const Json& plugins);

}  // namespace sparkctl
