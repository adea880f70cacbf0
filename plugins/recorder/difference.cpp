#include "difference.h"

#include <fmt/format.h>

#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/state.h"

namespace spark::recorder {

namespace {
std::string saved(const Leaf& leaf) {
  StateWriter out(true);
  saveTree(leaf, out);
  return out.bytes();
}

/// The first difference in what `leaf` itself saves.
std::string inLeaf(const Leaf& leaf, std::string_view bytes) {
  // What the kernel saves comes before the properties of the root.
  if (ClassObject* c = leaf.parent() ? leaf.classObject() : nullptr)
    for (const Property* p : c->stateProperties()) {
      const Value live = p->get(leaf);
      StateWriter own(true);
      own.write(live);
      if (bytes.substr(0, own.bytes().size()) != own.bytes()) {
        std::string other = "what cannot be read";
        try {
          other = StateReader(bytes).readValue().text();
        } catch (const Error&) {
        }
        return fmt::format("{}.{}: {} against {} in the recording", leaf.path(), p->name, live.text(), other);
      }
      bytes.remove_prefix(own.bytes().size());
    }
  return fmt::format("{}: what {} saves itself", leaf.path(),
                     leaf.parent() ? leaf.classObject()->name() : "the kernel");
}

std::string below(const Leaf& leaf, std::string_view& bytes) {
  const std::string all = saved(leaf);
  if (bytes.substr(0, all.size()) == all) return bytes.remove_prefix(all.size()), "";
  const Node* const node = leaf.asNode();
  std::size_t own = all.size();
  if (node)
    for (const auto& child : node->children()) own -= saved(*child).size();
  if (bytes.substr(0, own) != std::string_view(all).substr(0, own)) return inLeaf(leaf, bytes);
  bytes.remove_prefix(own);
  if (node)
    for (const auto& child : node->children())
      if (std::string found = below(*child, bytes); !found.empty()) return found;
  return fmt::format("{}: its state has another size", leaf.path());
}
}  // namespace

std::string firstDifference(const Leaf& root, std::string_view bytes) {
  std::string found = below(root, bytes);
  if (found.empty() && !bytes.empty()) found = "the recording has more nodes";
  return found;
}

}  // namespace spark::recorder
