#pragma once
/// \file
/// Properties that the host shows and reports, read by path, since the host depends on no plugin. If there is no such
/// node, the value is empty or 0.

#include <string>

#include "spark/class_object.h"
#include "spark/node.h"

namespace sparkhost {

inline constexpr const char* kSimulation = "/sys/server/simulation";
inline constexpr const char* kNet = "/sys/server/net";
inline constexpr const char* kSpades = "/sys/server/spades";
inline constexpr const char* kWeb = "/sys/server/web";
inline constexpr const char* kGameControl = "/sys/server/gamecontrol";

/// The value of a property; nil if there is no such node or property.
inline spark::Value valueAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Leaf* leaf = root.find(path);
  if (!leaf || !leaf->classObject()->property(property)) return {};
  return spark::getProperty(*leaf, property);
}
/// The same as an integer; 0 if it is not a number.
inline std::int64_t integerAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Value v = valueAt(root, path, property);
  return v.isNumber() ? static_cast<std::int64_t>(v.toNumber()) : 0;
}
/// The same as a number; 0 if it is not one.
inline double numberAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Value v = valueAt(root, path, property);
  return v.isNumber() ? v.toNumber() : 0;
}
/// The same as text; "" if it is nil.
inline std::string textAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Value v = valueAt(root, path, property);
  return v.isNil() ? std::string() : v.plain();
}

}  // namespace sparkhost
