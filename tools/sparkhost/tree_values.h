#pragma once
/// \file
/// Values that the host shows and reports, read from the tree by path: the host knows no plugin. Where a house has no
/// such node, the value is empty or 0.

#include <string>

#include "spark/class_object.h"
#include "spark/node.h"

namespace sparkhost {

inline constexpr const char* kSimulation = "/sys/server/simulation";
inline constexpr const char* kNet = "/sys/server/net";
inline constexpr const char* kWeb = "/sys/server/web";
inline constexpr const char* kGameControl = "/sys/server/gamecontrol";

/// A property's value, nil when there is no such node or property.
inline spark::Value valueAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Leaf* leaf = root.find(path);
  if (!leaf || !leaf->classObject()->property(property)) return {};
  return spark::getProperty(*leaf, property);
}
inline std::int64_t integerAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Value v = valueAt(root, path, property);
  return v.isNumber() ? static_cast<std::int64_t>(v.toNumber()) : 0;
}
inline double numberAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Value v = valueAt(root, path, property);
  return v.isNumber() ? v.toNumber() : 0;
}
inline std::string textAt(const spark::Leaf& root, const char* path, const char* property) {
  const spark::Value v = valueAt(root, path, property);
  return v.isNil() ? std::string() : v.plain();
}

}  // namespace sparkhost
