#include "environment.h"

#include <fmt/format.h>

#include "spark/error.h"

namespace spark::rsg {

Environment::Environment(const Program& program, std::vector<std::string> arguments, bool byName)
    : program_(program),
      arguments_(std::move(arguments)),
      values_(program.variables.size()),
      index_(program.variables.size(), kUndeclared),
      given_(arguments_.size()),
      byName_(byName) {}

void Environment::parameter(std::size_t slot) {
  if (index_[slot] != kUndeclared) throw Error(fmt::format("the name {} exists already", program_.variables[slot]));
  index_[slot] = names_++;
  const std::size_t position = parameters_++;
  if (byName_ && position < arguments_.size()) values_[slot] = arguments_[position];
}

void Environment::define(std::size_t slot, std::string value) {
  const bool declared = index_[slot] != kUndeclared;
  if (byName_) {
    if (!declared) index_[slot] = names_++;
    values_[slot] = std::move(value);
  } else if (declared) {
    const std::size_t i = index_[slot];
    if (i >= arguments_.size()) missing(slot);
    arguments_[i] = std::move(value);
  } else {
    // As in the installed base: the value goes to the end of the list, whatever position the name has.
    arguments_.push_back(std::move(value));
    index_[slot] = names_++;
  }
}

const std::string& Environment::value(std::size_t slot) const {
  if (byName_) {
    if (!values_[slot]) missing(slot);
    return *values_[slot];
  }
  // kUndeclared converts to a position beyond any list.
  const std::size_t i = index_[slot];
  if (i >= arguments_.size()) missing(slot);
  return arguments_[i];
}

void Environment::missing(std::size_t slot) const {
  const std::string& name = program_.variables[slot];
  if (index_[slot] != kUndeclared)
    throw Error(fmt::format("parameter {} was not given: the import passed {} arguments", name, given_));

  // Not declared: suggest a similar name, or list all.
  std::vector<std::string> names;
  for (std::size_t i = 0; i < index_.size(); ++i)
    if (index_[i] != kUndeclared) names.push_back(program_.variables[i]);
  const std::string near = didYouMean(name, names);
  const std::string all = names.empty() ? "" : fmt::format(" There are {}.", fmt::join(names, ", "));
  throw Error(fmt::format("there is no variable {} here.{}", name, near.empty() ? all : near));
}

}  // namespace spark::rsg
