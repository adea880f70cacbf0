#pragma once
/// \file
/// Names of the nodes of one MJCF model, and of its perceptors and effectors in messages.

#include <set>
#include <string>

#include "spark/node.h"

namespace spark::mjcf {

/// Makes names from those of the file, where XML allows any character.
///
/// In the tree `/ \ [ ]` and control characters become `_`, and a prefix comes first. In messages there is no prefix,
/// and spaces, control characters and `( ) " ' ; \` become `_`, since the names are atoms of S-expressions. A name that
/// is taken gets `~2`, `~3`, ... at its end.
class Names {
 public:
  explicit Names(std::string prefix) : prefix_(std::move(prefix)) {}
  /// A name that no child of `parent` has. `given` "": it is made of `kind` and a number.
  std::string in(const Node& parent, const std::string& given, const char* kind);
  /// As in(), without the prefix.
  std::string unprefixed(const Node& parent, const std::string& given, const char* kind);
  // Names that no other body or collider of the model has either: joints name bodies, and colliders exclude each other,
  // by name.
  std::string body(const Node& parent, const std::string& given, const char* kind);
  std::string collider(const Node& parent, const std::string& given);
  // Names in messages, which no other perceptor, or effector, of the model has.
  std::string perceptor(const std::string& given) { return message(perceptors_, given); }
  std::string effector(const std::string& given) { return message(effectors_, given); }

 private:
  std::string treeName(const std::string& prefix, const std::string& given, const char* kind);
  static std::string message(std::set<std::string, std::less<>>& taken, const std::string& given);

  std::string prefix_;
  std::set<std::string, std::less<>> bodies_, colliders_, perceptors_, effectors_;
  int unnamed_ = 0;
};

}  // namespace spark::mjcf
