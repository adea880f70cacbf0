#pragma once
/// \file
/// Private to the kernel: the one place that links, moves, unlinks, destroys and orders nodes.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "spark/in_use.h"
#include "spark/node.h"

namespace spark::detail {

/// How a node joins and leaves. link: onLink of the parent, its hooks, then its children's; when one throws, what was
/// linked is unlinked again and attach() throws. unlink: children first, then onUnlink, then its handlers go. Both may
/// change the tree around them, so lists are walked by index and looked at again; only what is being linked or unlinked
/// itself must stay where it is (`changing_`). Once all is unlinked references turn empty, then destructors run: none
/// sees another object half destroyed.
class Tree {
 public:
  explicit Tree(Kernel& kernel) : kernel_(kernel) {}

  /// Makes `root` the root of the tree.
  void plant(std::unique_ptr<Leaf> root);
  /// Destroys all but classes and plugins.
  void fell();
  /// Destroys the rest.
  void uproot();
  /// nullptr before plant().
  Node* root() const { return root_.get(); }
  /// /classes and /plugins, whose children only the kernel makes.
  Node* classes = nullptr;
  Node* plugins = nullptr;

  /// Counts changes of shape and names.
  const std::uint64_t& version() const { return version_; }
  /// The shape, or a name, changed at `node` or right below it.
  void markChanged(Node* node);
  /// Lists and numbers all linked nodes in tree order, when the shape has changed.
  void updateOrder();
  /// All linked nodes, parents first; valid while isOrdered().
  const std::vector<Leaf*>& order() const { return order_; }
  bool isOrdered() const { return orderedAt_ == version_; }
  /// Indices in order(): of a linked leaf, and of the last leaf below it (its own without one). Where parents come last
  /// a leaf's index is postOrder().
  static std::uint32_t preOrder(const Leaf& leaf) { return leaf.preOrder_; }
  static std::uint32_t lastBelow(const Leaf& leaf) { return leaf.lastBelow_; }
  static std::uint32_t postOrder(const Leaf& leaf) { return leaf.postOrder_; }

  /// Gives a new object its class and its id.
  void adopt(Leaf& leaf, ClassObject& c);
  /// Takes the class away: `leaf` outlives it.
  static void disown(Leaf& leaf) { leaf.class_ = nullptr; }
  std::uint64_t lastId() const { return nextId_ - 1; }
  /// Appends `leaf` to `parent`, and links it where the parent is linked. Throws what onLink throws; `leaf` is then
  /// destroyed and the tree as before.
  Leaf& attach(Node& parent, std::unique_ptr<Leaf> leaf);
  /// As attach, in order of name. For parents of which nobody else adds children.
  Leaf& attachSorted(Node& parent, std::unique_ptr<Leaf> leaf);
  /// Unlinks a child and destroys it.
  void detach(Leaf& child);
  /// Takes a child away without unlinking it.
  static std::unique_ptr<Leaf> take(Leaf& child);
  /// Moves a child; throws what onMoved and onLink throw, the child is then back as the last one.
  void move(Leaf& child, Node& to);
  /// Renames without a check.
  static void rename(Leaf& leaf, std::string name);

  /// True for the root, /classes, /plugins and what is in these.
  bool isFixed(const Leaf& leaf) const;
  /// Throws Error when `leaf` cannot go or move now: fixed, in use, or being linked or unlinked. `verb`: "remove".
  void refuseFixed(const Leaf& leaf, const char* verb) const;
  /// Throws Error when `leaf`, or what is below it, is in use; to be renamed: also when its name is kept. `doing`:
  /// "cannot remove /a now".
  void refuseUsed(const Leaf& leaf, bool rename, const std::string& doing) const;

  /// A channel has a handler of `leaf`, which goes with it.
  static void setHooked(Leaf& leaf, bool hooked) { leaf.hooked_ = hooked; }
  static bool isHooked(const Leaf& leaf) { return leaf.hooked_; }
  static void saveState(const Leaf& leaf, StateWriter& out) { leaf.saveState(out); }
  static void loadState(Leaf& leaf, StateReader& in) { leaf.loadState(in); }

 private:
  friend class spark::InUse;
  struct Changing;
  void link(Leaf& leaf);
  void linkChildren(Node& node);
  void unlink(Leaf& leaf);
  void unlinkChildren(Leaf& leaf);
  void callOnUnlink(Leaf& leaf);
  void moved(Leaf& leaf);
  static void emptyReferences(Leaf& leaf);
  static void destroyBelow(Node& node);
  void number(Leaf& leaf, std::uint32_t& post);

  Kernel& kernel_;
  std::unique_ptr<Node> root_;
  std::uint64_t version_ = 1, orderedAt_ = 0, nextId_ = 1;
  std::vector<Leaf*> order_;
  int changing_ = 0;        ///< leaves that are being linked, moved or unlinked
  InUse* inUse_ = nullptr;  ///< the newest first
};

}  // namespace spark::detail
