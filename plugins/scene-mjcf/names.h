#pragma once
/// \file
/// Names of the nodes of one MJCF model.

#include <set>
#include <string>

namespace spark::mjcf {

/// Makes names that paths can have, with a prefix.
class Names {
 public:
  explicit Names(std::string prefix) : prefix_(std::move(prefix)) {}
  /// `given` "": a name is made of `kind` and a number.
  std::string name(const std::string& given, const char* kind);
  // A name that no other body or collider of the model has: joints name bodies, and colliders exclude each other by
  // name.
  std::string body(const std::string& given, const char* kind) { return unique(bodies_, name(given, kind)); }
  std::string collider(const std::string& given) { return unique(colliders_, name(given, "geom")); }

 private:
  static std::string unique(std::set<std::string>& taken, const std::string& name);

  std::string prefix_;
  std::set<std::string> bodies_, colliders_;
  int unnamed_ = 0;
};

}  // namespace spark::mjcf
