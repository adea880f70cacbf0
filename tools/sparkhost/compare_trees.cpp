#include "compare_trees.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/scene_calls.h"
#include "spark/class_object.h"
#include "spark/random.h"
#include "spark/state.h"

namespace sparkhost {

using namespace spark;

namespace {

bool agree(const Value& a, const Value& b) {
  if (a.isList() && b.isList())
    return std::equal(a.toList().begin(), a.toList().end(), b.toList().begin(), b.toList().end(), agree);
  if (!a.isNumber() || !b.isNumber()) return a == b;
  const double x = a.toNumber(), y = b.toNumber();
  return x == y || std::abs(x - y) <= 1e-6 * std::max({1.0, std::abs(x), std::abs(y)});
}

std::string differenceAt(const Leaf& original, const Leaf& converted) {
  const std::string path = original.path(), type = original.classObject()->name();
  if (original.name() != converted.name() || type != converted.classObject()->name())
    return fmt::format("in the place of {} ({}) there is {} ({})", path, type, converted.name(),
                       converted.classObject()->name());
  for (const Property* p : original.classObject()->properties()) {
    if (p->ofProcess || p->type == Convert<RandomStream>::typeName()) continue;
    const Value a = p->get(original), b = p->get(converted);
    if (!agree(a, b))
      return fmt::format("{}.{} is {}, and {} in the converted file", path, p->name, a.text(), b.text());
  }
  const Node *first = original.asNode(), *second = converted.asNode();
  if (first) return sparkhost::differenceOf(*first, *second);
  if (!original.as<ISceneCalls>() && stateHash(original) != stateHash(converted))
    return fmt::format("the state of {} ({}) is another one in the converted file", path, type);
  return {};
}

}  // namespace

std::string differenceOf(const Node& original, const Node& converted) {
  const auto &a = original.children(), &b = converted.children();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (std::string found = differenceAt(*a[i], *b[i]); !found.empty()) return found;
  if (a.size() == b.size()) return {};
  return a.size() > b.size()
             ? fmt::format("{} is not in the converted file", a[b.size()]->path())
             : fmt::format("{} has one more node in the converted file, {}", original.path(), b[a.size()]->name());
}

}  // namespace sparkhost
