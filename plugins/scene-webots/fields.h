#pragma once
/// \file
/// The fields of a node by their types.

#include <array>
#include <set>

#include "api/math.h"
#include "syntax.h"

namespace spark::webots {

/// Reads the fields of one node. What is read is known; finish() names the others. A field with NULL, or without a
/// value, is not there. One with a value of another type is named, and as if it were not there.
class Fields {
 public:
  /// Both must outlive this.
  Fields(const Node& node, mjcf::Unsupported& unsupported) : node_(node), unsupported_(unsupported) {}
  const Node& node() const { return node_; }
  mjcf::Element element() const { return node_.element(); }
  /// The place of a field, or of the node where it is not there, and a text, to be thrown.
  Error error(const char* name, const std::string& text) const;
  /// Names what is wrong about a field, or about the node where it is not there.
  void wrong(const char* name, const std::string& text) const;

  double number(const char* name, double otherwise);
  /// A number that is at least `least`.
  double number(const char* name, double otherwise, double least);
  bool flag(const char* name, bool otherwise);
  std::string text(const char* name, const char* otherwise = "");
  Vec3 vector(const char* name, const Vec3& otherwise);
  /// SFRotation: an axis and an angle [rad].
  Mat3 rotation(const char* name);
  /// nullptr where it is not there. The list is valid as long as the node.
  const std::vector<double>* numbers(const char* name);
  const std::vector<std::string>* texts(const char* name);
  const Node* child(const char* name);
  const std::vector<NodePtr>& children(const char* name);
  /// True for a field that is there.
  bool has(const char* name) { return find(name) != nullptr; }
  /// Fields that mean nothing to a simulation.
  void ignore(std::initializer_list<const char*> names) {
    for (const char* name : names) known_.insert(name);
  }
  /// Names the fields that were not read.
  void finish();

 private:
  const Field* find(const char* name);
  const std::vector<double>* exactly(const char* name, std::size_t count, const char* what);
  void expected(const Field& field, const std::string& what) const;

  const Node& node_;
  mjcf::Unsupported& unsupported_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace spark::webots
