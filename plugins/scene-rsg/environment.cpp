#include "environment.h"

#include "spark/error.h"

namespace spark::rsg {

Environment::Environment(const Program& program, std::vector<std::string> arguments, bool byName)
    : program_(program),
      arguments_(std::move(arguments)),
      values_(program.variables.size()),
      index_(program.variables.size(), -1),
      given_(arguments_.size()),
      byName_(byName) {}

void Environment::parameter(int slot) {
  const auto s = static_cast<std::size_t>(slot);
  if (index_[s] >= 0) throw Error("the name " + program_.variables[s] + " exists already");
  index_[s] = names_++;
  const auto position = static_cast<std::size_t>(parameters_++);
  if (byName_ && position < arguments_.size()) values_[s] = arguments_[position];
}

void Environment::define(int slot, std::string value) {
  const auto s = static_cast<std::size_t>(slot);
  if (byName_) {
    if (index_[s] < 0) index_[s] = names_++;
    values_[s] = std::move(value);
  } else if (index_[s] >= 0) {
    const auto i = static_cast<std::size_t>(index_[s]);
    if (i >= arguments_.size()) missing(slot);
    arguments_[i] = std::move(value);
  } else {
    arguments_.push_back(std::move(value));
    index_[s] = names_++;
  }
}

const std::string& Environment::value(int slot) const {
  const auto s = static_cast<std::size_t>(slot);
  if (byName_ && values_[s]) return *values_[s];
  if (!byName_ && index_[s] >= 0 && static_cast<std::size_t>(index_[s]) < arguments_.size())
    return arguments_[static_cast<std::size_t>(index_[s])];
  missing(slot);
}

void Environment::missing(int slot) const {
  const std::string& name = program_.variables[static_cast<std::size_t>(slot)];
  if (index_[static_cast<std::size_t>(slot)] >= 0)
    throw Error("parameter " + name + " was not given: the import passed " + std::to_string(given_) + " arguments");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < index_.size(); ++i)
    if (index_[i] >= 0) names.push_back(program_.variables[i]);
  const std::string near = didYouMean(name, names);
  std::string all;
  for (const std::string& n : names) all += (all.empty() ? " There are " : ", ") + n;
  throw Error("there is no variable " + name + " here." + (near.empty() && !all.empty() ? all + "." : near));
}

}  // namespace spark::rsg
