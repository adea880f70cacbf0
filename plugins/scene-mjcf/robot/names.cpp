#include "names.h"

#include <fmt/format.h>

namespace spark::mjcf {

namespace {

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Replaces control characters and those in `others`.
std::string replaced(std::string name, std::string_view others) {
  for (char& c : name)
    if (isControl(c) || others.find(c) != std::string_view::npos) c = '_';
  return name;
}

/// The first of name, name~2, name~3, ... that is free.
template <class IsFree>
std::string firstFree(const std::string& name, IsFree isFree) {
  std::string candidate = name;
  for (int i = 2; !isFree(candidate); ++i) candidate = fmt::format("{}~{}", name, i);
  return candidate;
}

}  // namespace

std::string Names::treeName(const std::string& prefix, const std::string& given, const char* kind) {
  std::string name = replaced(prefix + (given.empty() ? fmt::format("{}{}", kind, ++unnamed_) : given), "/\\[]");
  if (name == "." || name == "..") name += '_';
  return name;
}

std::string Names::in(const Node& parent, const std::string& given, const char* kind) {
  return firstFree(treeName(prefix_, given, kind), [&](const std::string& name) { return !parent.child(name); });
}

std::string Names::unprefixed(const Node& parent, const std::string& given, const char* kind) {
  return firstFree(treeName("", given, kind), [&](const std::string& name) { return !parent.child(name); });
}

std::string Names::body(const Node& parent, const std::string& given, const char* kind) {
  return firstFree(treeName(prefix_, given, kind),
                   [&](const std::string& name) { return !parent.child(name) && bodies_.insert(name).second; });
}

std::string Names::collider(const Node& parent, const std::string& given) {
  return firstFree(treeName(prefix_, given, "geom"),
                   [&](const std::string& name) { return !parent.child(name) && colliders_.insert(name).second; });
}

std::string Names::message(std::set<std::string, std::less<>>& taken, const std::string& given) {
  return firstFree(replaced(given, " ()\"';\\"), [&](const std::string& name) { return taken.insert(name).second; });
}

}  // namespace spark::mjcf
