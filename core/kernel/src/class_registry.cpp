#include "class_registry.h"

#include <algorithm>

#include "spark/error.h"
#include "spark/kernel.h"
#include "tree.h"

namespace spark::detail {

ClassObject& ClassRegistry::add(ClassDescription description, Plugin* plugin) {
  if (ClassObject* other = find(description.name))
    throw Error("class '" + description.name + "' is registered already, by " +
                (other->plugin() ? "plugin '" + other->plugin()->name() + "'" : "the kernel") +
                ". Two plugins cannot provide one name: use only one of them.");
  auto made = std::make_unique<ClassObject>(kernel_, std::move(description), plugin);
  ClassObject& c = *made;
  // The first class is of itself until the class of classes comes.
  kernel_.tree().adopt(c, classOfClasses_ ? *classOfClasses_ : c);
  if (c.name() == ClassObject::kClassName) {
    classOfClasses_ = &c;
    for (auto& [name, other] : index_) kernel_.tree().adopt(*other, c);
  }
  index_.emplace(c.name(), &c);
  if (kernel_.tree().classes)
    kernel_.tree().attachSorted(*kernel_.tree().classes, std::move(made));
  else
    made.release();  // hang() gives the first classes to the tree
  return c;
}

void ClassRegistry::hang() {
  for (auto& [name, c] : index_) kernel_.tree().attach(*kernel_.tree().classes, std::unique_ptr<Leaf>(c));
}

void ClassRegistry::drop(ClassObject& c, bool leak) {
  index_.erase(index_.find(c.name()));
  if (leak)
    Tree::take(c).release();
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
