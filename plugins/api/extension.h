#pragma once
/// \file
/// Numbers that one engine knows of an element of a world: blocks of plain data beside the model, made by nodes of that
/// engine's plugin. The plugin `physics` passes them on and does not read them.
///
///     struct Numbers {
///       static constexpr std::string_view kKind = "JoltSurface";
///       double bounce = 0;
///     };
///     class JoltSurface : public engine::Extension<Numbers> {      // a child of a collider
///       SPARK_CLASS(JoltSurface, Leaf)
///       static void describe(Description<JoltSurface>& d) {
///         engine::describeExtension(d, "What Jolt alone reads of a collider.");
///         d.property("bounce", &JoltSurface::get<&Numbers::bounce>, &JoltSurface::set<&Numbers::bounce>);
///       }
///     };
///     model.extensions.geoms[i].get<Numbers>().bounce              // in the engine

#include <fmt/format.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "api/blocks.h"
#include "spark/abi/api/extension.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/node.h"

namespace spark::engine {

/// A node whose element takes blocks: a World, a collider, a joint.
class IExtended {
 public:
  SPARK_INTERFACE(IExtended, 1);
  virtual ~IExtended() = default;
  virtual void setBlock(const Block& block) = 0;
  virtual void removeBlock(std::uint64_t kind) = 0;
};

/// The world of a scene: it takes the blocks of what belongs to no single element.
class IExtendedWorld {
 public:
  SPARK_INTERFACE(IExtendedWorld, 2);
  virtual ~IExtendedWorld() = default;
  virtual IExtended& blocks() = 0;
  /// Sets the input of one of its blocks, see BlockInput: from the next step on, and without a change of the model. It
  /// ends with the block.
  virtual void setInput(std::uint64_t kind, double value) = 0;
};

/// The world of the scene that a node is in; nullptr: there is none.
inline IExtendedWorld* extendedWorldAround(const Leaf& node) {
  for (const Node* up = node.parent(); up; up = up->parent())
    if (auto* world = up->childOf<IExtendedWorld>()) return world;
  return nullptr;
}
inline IExtended* worldAround(const Leaf& node) {
  IExtendedWorld* const world = extendedWorldAround(node);
  return world ? &world->blocks() : nullptr;
}

/// A node with a block.
class IExtension {
 public:
  SPARK_INTERFACE(IExtension, 2);
  virtual ~IExtension() = default;
  virtual Leaf& leaf() = 0;
  /// What the author of a scene wrote, for messages: "<mimic> (arm.urdf:9:5)"; the name of the node's class, unless an
  /// importer made it. "": nothing that a file says, so nothing is lost where it has no effect.
  virtual std::string writtenAs() const = 0;
  /// That of the name, without a number. Engines say which kinds they read: IEngine::reads().
  virtual std::uint64_t kind() const = 0;
};

/// Base of nodes with a block of type T, for the element above them, or another one (element()). See the file comment.
template <class T>
class Extension : public Leaf, public IExtension {
 public:
  Leaf& leaf() override { return *this; }
  std::uint64_t kind() const override { return kindOf(T::kKind); }
  std::string writtenAs() const override { return writtenAs_.value_or(std::string(classObject()->name())); }
  void setWrittenAs(std::string text) { writtenAs_ = std::move(text); }
  const T& numbers() const { return numbers_; }
  template <auto Member>
  auto get() const {
    return numbers_.*Member;
  }
  template <auto Member>
  void set(std::decay_t<decltype(std::declval<T>().*Member)> v) {
    numbers_.*Member = v;
    pass();
  }

 protected:
  /// Which of several blocks of this kind in one element it is.
  virtual int number() const { return 0; }
  /// The element that takes the block: the node above.
  virtual IExtended* element() { return parent() ? parent()->template as<IExtended>() : Found<IExtended>(); }
  /// Passes the numbers to the element; before the node is linked it does nothing.
  void pass() {
    if (above_) above_->setBlock(Block::of(numbers_, number()));
  }
  /// Takes them back.
  void withdraw() {
    if (above_) above_->removeBlock(Block::of(numbers_, number()).kind);
  }
  void onLink() override {
    Leaf::onLink();
    above_ = element();
    if (!above_)
      throw Error(
          fmt::format("{}: expected a World, a collider or a joint above it: it holds numbers of that, or of the "
                      "world of its scene",
                      path()));
    pass();
  }
  void onUnlink() override {
    withdraw();
    above_ = nullptr;
    Leaf::onUnlink();
  }

 private:
  T numbers_{};
  std::optional<std::string> writtenAs_;
  IExtended* above_ = nullptr;
};

/// Describes what all extensions have.
template <class E>
void describeExtension(Description<E>& d, const char* doc) {
  d.doc(doc);
  d.template implements<IExtension>();
  d.method("setWrittenAs", &E::setWrittenAs)
      .parameters({"text"})
      .doc("What a file says of which an importer made it; messages name that in place of the class. Empty: nothing.");
}

}  // namespace spark::engine
