#include "variables.h"

#include "spark/state_fields.h"

namespace spark {

void Variables::describe(Description<Variables>& d) {
  d.doc("A group of named variables that scene files read as Group.name.");
  d.implements<IVariables>();
  d.method("set", &Variables::set).parameters({"name", "value"}).doc("Sets a variable; nil removes it.");
  d.method("get", &Variables::get).parameters({"name"}).doc("The variable's value, nil when there is none.");
  d.property("names", &Variables::names).doc("Names of all variables, sorted.");
  d.property("value", &Variables::value_)
      .state()
      .doc("Value of the group itself, without a member: a list, indexed from 0, or a table of names.");
}

Value Variables::variable(std::string_view name) const {
  if (name.empty()) return value_;
  const auto found = variables_.find(name);
  return found == variables_.end() ? Value() : found->second;
}

void Variables::set(std::string name, Value value) {
  if (name.empty())
    value_ = std::move(value);
  else if (value.isNil())
    variables_.erase(name);
  else
    variables_.insert_or_assign(std::move(name), std::move(value));
}

std::vector<std::string> Variables::names() const {
  std::vector<std::string> out;
  for (const auto& [name, value] : variables_) out.push_back(name);
  return out;
}

void Variables::saveState(StateWriter& out) const { saveFields(out, variables_); }
void Variables::loadState(StateReader& in) { loadFields(in, variables_); }

}  // namespace spark
