#pragma once
/// \file
/// Compares two trees by all that can be read of their nodes.

#include <cmath>
#include <string>
#include <vector>

#include "spark/class_object.h"
#include "spark/node.h"

namespace spark::test {

/// Equal to the last bit; no number equals no number.
inline bool same(const Value& a, const Value& b) {
  if (a.isList() && b.isList()) {
    const List &x = a.toList(), &y = b.toList();
    if (x.size() != y.size()) return false;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!same(x[i], y[i])) return false;
    return true;
  }
  if (a.type() == Value::Type::number && b.type() == Value::Type::number)
    return a.toNumber() == b.toNumber() || (std::isnan(a.toNumber()) && std::isnan(b.toNumber()));
  return a == b;
}

/// A line for each value that the hash of the configuration holds.
inline std::vector<std::string> configurationOf(const Leaf& leaf) {
  std::vector<std::string> out;
  if (ClassObject* c = leaf.classObject())
    for (const Property* p : c->properties())
      if (p->isConfiguration()) out.push_back(leaf.path() + "." + p->name + " = " + p->get(leaf).text());
  if (const Node* node = leaf.asNode())
    for (const auto& child : node->children()) {
      const auto lines = configurationOf(*child);
      out.insert(out.end(), lines.begin(), lines.end());
    }
  return out;
}

/// One line for each property of `a` and its descendants that the node at the same place below `b` has not alike, but
/// for those that tell of the process. Trees of different shape: a line for the first difference.
inline void compareReadable(const Leaf& a, const Leaf& b, std::vector<std::string>& out) {
  if (a.classObject() != b.classObject() && a.classObject()->name() != b.classObject()->name()) {
    out.push_back(a.path() + ": " + a.classObject()->name() + " against " + b.classObject()->name());
    return;
  }
  for (const Property* p : a.classObject()->properties()) {
    if (p->ofProcess) continue;
    const Property* other = b.classObject()->property(p->name);
    const Value x = p->get(a), y = other->get(b);
    if (!same(x, y))
      out.push_back(a.path() + "." + p->name + " (" + a.classObject()->name() + "): " + x.text() + " against " +
                    y.text());
  }
  const Node *n = a.asNode(), *m = b.asNode();
  if (!n || !m) return;
  if (n->children().size() != m->children().size()) {
    out.push_back(a.path() + ": another number of children");
    return;
  }
  for (std::size_t i = 0; i < n->children().size(); ++i) compareReadable(*n->children()[i], *m->children()[i], out);
}

/// The same for /sys/server, /sys/variables and /usr of two kernels.
inline std::vector<std::string> readableDifferences(Kernel& a, Kernel& b) {
  std::vector<std::string> out;
  for (const char* path : {"/sys/server", "/sys/variables", "/usr"})
    if (const Leaf* x = a.root().find(path), *y = b.root().find(path); x && y) compareReadable(*x, *y, out);
  return out;
}

}  // namespace spark::test
