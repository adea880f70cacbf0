#pragma once
/// \file
/// Answers as people read them.

#include <nlohmann/json.hpp>
#include <string>

namespace sparkctl {

using Json = nlohmann::ordered_json;

/// A tree with classes and one sentence each. Unless `all`, runs of more than a few brothers of one class are
/// shortened.
std::string treeText(const Json& node, const std::string& path, bool all);
/// `name = value unit`, with type, range and documentation below.
std::string propertyText(const Json& property);
/// JSON with a line for each part of a list.
std::string answerText(const Json& answer);
/// One line a plugin.
std::string pluginsText(const Json& plugins);

}  // namespace sparkctl
