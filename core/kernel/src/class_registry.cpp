#include "class_registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "spark/error.h"
#include "spark/kernel.h"
#include "tree.h"

namespace spark::detail {

ClassObject& ClassRegistry::add(ClassDescription description, Plugin* plugin) {
  if (ClassObject* other = find(description.name))
    throw Error(fmt::format(
        "class '{}' is registered already, by {}. Two plugins cannot provide one name: use only one of them.",
        description.name, other->plugin() ? fmt::format("plugin '{}'", other->plugin()->name()) : "the kernel"));
  auto made = std::make_unique<ClassObject>(kernel_, std::move(description), plugin);
  ClassObject& c = *made;
  // Classes that are registered before the class of classes get it later.
  kernel_.tree().adopt(c, classOfClasses_ ? *classOfClasses_ : c);
  if (c.name() == ClassObject::kClassName) {
    classOfClasses_ = &c;
    for (auto& [name, other] : index_) kernel_.tree().adopt(*other, c);
  }
  index_.emplace(c.name(), &c);
  if (kernel_.tree().classes)
    kernel_.tree().attachSorted(*kernel_.tree().classes, std::move(made));
  else
    static_cast<void>(made.release());  // owned by index_ until hang()
  return c;
}

void ClassRegistry::hang() {
  for (auto& [name, c] : index_) kernel_.tree().attach(*kernel_.tree().classes, std::unique_ptr<Leaf>(c));
}

void ClassRegistry::drop(ClassObject& c, bool leak) {
  index_.erase(index_.find(c.name()));
  if (leak)
    static_cast<void>(Tree::take(c).release());  // never destroyed
  else
    kernel_.tree().detach(c);
}

std::vector<std::unique_ptr<Leaf>> ClassRegistry::takeAll() {
  std::vector<std::unique_ptr<Leaf>> out;
  const auto& all = kernel_.tree().classes->children();
  while (!all.empty()) out.push_back(Tree::take(*all.back()));
  std::reverse(out.begin(), out.end());
  return out;
}

ClassObject* ClassRegistry::find(std::string_view name) const {
  const auto it = index_.find(name);
  if (it != index_.end()) return it->second;
  const std::size_t slash = name.rfind('/');
  return slash == std::string_view::npos ? nullptr : find(name.substr(slash + 1));
}

}  // namespace spark::detail
