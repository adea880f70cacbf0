#pragma once
/// \file
/// What a node needs beside its properties when it is written to a scene file.

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/api/scene_calls.h"
#include "spark/interface.h"
#include "spark/leaf.h"
#include "spark/value.h"

namespace spark {

/// A call of a described method.
struct SceneCall {
  std::string method;
  List arguments;
};

/// A node of which scene files call methods, because its properties alone do not make it what it is.
class ISceneCalls {
 public:
  SPARK_INTERFACE(ISceneCalls, 1);
  virtual ~ISceneCalls() = default;
  /// The calls that make a new node of this class in the same place what this one is, in their order, before its
  /// properties are set. Throws Error for what no call can express.
  virtual std::vector<SceneCall> sceneCalls() const = 0;
  /// The names of properties that these calls set.
  virtual std::vector<std::string_view> setByCalls() const { return {}; }
};

/// The number with the fewest digits that is read as this one in single precision.
inline double shortest(float v) {
  char text[32];
  double number = v;
  std::from_chars(text, std::to_chars(text, text + sizeof text, v).ptr, number);
  return number;
}

/// The path of `to` relative to `from`, both in the tree.
inline std::string relativePath(const Leaf& from, const Leaf& to) {
  const std::string a = from.path() + '/', b = to.path() + '/';
  // The common beginning, in whole names.
  std::size_t common = 0;
  for (std::size_t i = 0; i < a.size() && i < b.size() && a[i] == b[i]; ++i)
    if (a[i] == '/') common = i + 1;
  std::string path;
  for (std::size_t i = common; i < a.size(); ++i)
    if (a[i] == '/') path += path.empty() ? ".." : "/..";
  if (common < b.size()) path += (path.empty() ? "" : "/") + b.substr(common, b.size() - common - 1);
  return path.empty() ? "." : path;
}

}  // namespace spark
