#include "names.h"

#include <fmt/format.h>

namespace spark::mjcf {

std::string Names::name(const std::string& given, const char* kind) {
  std::string name = prefix_ + (given.empty() ? fmt::format("{}{}", kind, ++unnamed_) : given);
  // What paths are made of.
  for (char& c : name)
    if (c == '/' || c == '[' || c == ']') c = '_';
  if (name == "." || name == "..") name += '_';
  return name;
}

std::string Names::unique(std::set<std::string>& taken, const std::string& name) {
  std::string unique = name;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}~{}", name, i);
  return unique;
}

}  // namespace spark::mjcf
