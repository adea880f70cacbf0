#pragma once
/// \file
/// Private to the kernel: the one class that links, moves, unlinks, destroys and numbers objects of the tree.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "spark/in_use.h"
#include "spark/node.h"

namespace spark::detail {

/// Changes the tree.
///
/// Linking an object: its onLink(), its hooks, then its children. If one of them throws, everything that was linked is
/// unlinked again, and attach() throws. Unlinking: the children, its onUnlink(), then its handlers. onLink() and
/// onUnlink() may change the tree around them, so lists of children are iterated by index and re-read after each call;
/// only an object that is being linked or unlinked must not be removed (`changing_`). When everything is unlinked,
/// references become empty, and then destructors run, so that none of them sees another object half destroyed.
class Tree {
 public:
  explicit Tree(Kernel& kernel) : kernel_(kernel) {}

  /// Makes `root` the root of the tree, with /classes and /plugins.
  void plant(std::unique_ptr<Leaf> root);
  /// Destroys everything except /classes and /plugins.
  void fell();
  /// Destroys the rest of the tree.
  void uproot();
  /// The root; nullptr before plant().
  Node* root() const { return root_.get(); }
  /// /classes and /plugins, whose children only the kernel makes.
  Node* classes = nullptr;
  Node* plugins = nullptr;

  /// The number of changes of shape and names.
  const std::uint64_t& version() const { return version_; }
  /// Counts a change of the shape, or of a name, of `node` or its children.
  void markChanged(Node* node);
  /// Lists and numbers all linked objects in tree order, if the tree has changed since the last call.
  void updateOrder();
  /// All linked objects, parents before children. Valid while isOrdered().
  const std::vector<Leaf*>& order() const { return order_; }
  bool isOrdered() const { return orderedAt_ == version_; }
  /// The index of a linked leaf in order().
  static std::uint32_t preOrder(const Leaf& leaf) { return leaf.preOrder_; }
  /// The index in order() of its last descendant, or its own if it has none.
  static std::uint32_t lastBelow(const Leaf& leaf) { return leaf.lastBelow_; }
  /// Its index in the order that has children before parents.
  static std::uint32_t postOrder(const Leaf& leaf) { return leaf.postOrder_; }

  /// Sets the class of a new object, and its id and name unless it has them.
  void adopt(Leaf& leaf, ClassObject& c);
  /// Removes the class of a leaf that outlives it.
  static void disown(Leaf& leaf) { leaf.class_ = nullptr; }
  /// The id of the newest object.
  std::uint64_t lastId() const { return nextId_ - 1; }
  /// Appends `leaf` to the children of `parent`, and links it if the parent is linked. Throws Error if the tree is too
  /// deep, and what onLink() throws; `leaf` is then destroyed and the tree as before.
  Leaf& attach(Node& parent, std::unique_ptr<Leaf> leaf);
  /// As attach(), but inserts `leaf` in order of name. All children of `parent` must be added by this function.
  Leaf& attachSorted(Node& parent, std::unique_ptr<Leaf> leaf);
  /// Unlinks a child and destroys it with its descendants.
  void detach(Leaf& child);
  /// Removes a child from its parent without unlinking it.
  static std::unique_ptr<Leaf> take(Leaf& child);
  /// Moves a child, see Node::reparent.
  void move(Leaf& child, Node& to);
  /// Renames without checks.
  static void rename(Leaf& leaf, std::string name);

  /// True for the root, /classes, /plugins and their children.
  bool isFixed(const Leaf& leaf) const;
  /// Throws Error if `leaf` cannot be removed or moved now: it is fixed, in use, or it or a descendant is being linked
  /// or unlinked. `verb`: "remove" or "move".
  void refuseFixed(const Leaf& leaf, const char* verb) const;
  /// Throws Error if `leaf` or a descendant is in use. `rename`: also if an ancestor is in use that protects the name
  /// of `leaf`. `doing` begins the message: "cannot remove /a now".
  void refuseUsed(const Leaf& leaf, bool rename, const std::string& doing) const;

  /// Sets whether some channel has handlers of `leaf`.
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
  int changing_ = 0;        ///< number of leaves that are being linked, moved or unlinked
  InUse* inUse_ = nullptr;  ///< list of all guards, the newest first
};

}  // namespace spark::detail
