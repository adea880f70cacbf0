#pragma once
/// \file
/// Vectors in text tables and as results of methods.

#include <istream>

#include "spark/describe.h"
#include "spark/node.h"

namespace spark::test {

/// Reads three numbers separated by blanks.
inline std::istream& operator>>(std::istream& in, Vec3& v) { return in >> v.x() >> v.y() >> v.z(); }

/// The result of a method without arguments.
inline Vec3 vectorOf(Leaf& node, const char* method) {
  const Value value = callMethod(node, method, {});
  Args args{};
  args.values = {&value, 1};
  return Convert<Vec3>::from(args);
}

}  // namespace spark::test
