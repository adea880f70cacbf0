#pragma once
/// \file
/// Private to the script server: members of nodes by name. These are properties, and the variables of a group, which is
/// a node whose class has the methods get and set and the property names.

#include <string>
#include <string_view>
#include <vector>

#include "spark/value.h"

namespace spark {
class Leaf;
}

namespace spark::script {

/// True if the node is a group of variables.
bool isGroup(const Leaf& leaf);
/// True if the node has a property or variable of that name.
bool hasMember(const Leaf& leaf, std::string_view name);
/// Sets a property or variable. In a group a name that is no property is a variable, which may be new. Throws Error as
/// setProperty().
void setMember(Leaf& leaf, std::string_view name, const Value& value);
/// The names of all properties and variables.
std::vector<std::string> memberNames(const Leaf& leaf);
/// What follows the sentence that a node has no member `name`: which of its `names` are similar, and which other
/// classes have a property of that name, if these are few.
std::string memberHint(const Leaf& leaf, std::string_view name, const std::vector<std::string>& names);

}  // namespace spark::script
