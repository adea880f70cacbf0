#pragma once
/// \file
/// Vectors of tables in text, and of what a node's methods return.

#include <istream>

#include "spark/describe.h"
#include "spark/node.h"

namespace spark::test {

/// Three numbers with blanks between them.
inline std::istream& operator>>(std::istream& in, Vec3& v) { return in >> v.x() >> v.y() >> v.z(); }

/// What a method without arguments returns.
inline Vec3 vectorOf(Leaf& node, const char* method) {
  const Value value = callMethod(node, method, {});
  Args args{};
  args.values = {&value, 1};
  return Convert<Vec3>::from(args);
}

}  // namespace spark::test
