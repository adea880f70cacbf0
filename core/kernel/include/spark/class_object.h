#pragma once
/// \file
/// Class objects: reflective factories in the tree (`/classes/<Name>`) that know base, interfaces, properties, methods,
/// hooks and links.

#include <memory>
#include <string>
#include <vector>

#include "spark/abi/spark/class_object.h"
#include "spark/access.h"
#include "spark/class_description.h"
#include "spark/leaf.h"

namespace spark {

class Plugin;

/// A class in the tree. Made by plugins that register, gone when their plugin goes.
class ClassObject : public Leaf {
 public:
  ClassObject(Kernel& kernel, ClassDescription description, Plugin* plugin);
  ~ClassObject() override;
  static constexpr const char* kClassName = "Class";
  using ClassSelf = ClassObject;
  using ClassBase = Leaf;
  static constexpr InterfaceId kInterface{"Class", 1};
  static void describe(Description<ClassObject>& d);

  const std::string& doc() const { return description_.doc; }
  const std::string& baseName() const { return description_.base; }
  bool isAbstract() const { return !description_.make; }
  /// The plugin that registered it; nullptr for the kernel's own classes.
  Plugin* plugin() const { return plugin_; }
  /// Number of objects of exactly this class that live now.
  std::size_t living() const { return living_; }

  /// Makes an unlinked object. Throws Error when the class is abstract or a base is not registered (and names the
  /// plugin that has it).
  std::unique_ptr<Leaf> create();
  /// The base's class object; nullptr for Leaf. Throws Error when it is not registered.
  ClassObject* base();
  /// True for the class itself and all its bases.
  bool isA(std::string_view className);
  /// Own and inherited, nullptr when there is none. The most derived wins. Names of scene files' methods work here.
  const Property* property(std::string_view name);
  const Method* method(std::string_view name);
  /// Own and inherited, bases first, in order of description.
  std::vector<const Property*> properties();
  std::vector<const Method*> methods();
  const std::vector<const Hook*>& hooks();
  const std::vector<const LinkDescription*>& links();
  /// The properties that are state, own and inherited, in order of properties().
  const std::vector<const Property*>& stateProperties();
  /// Own interfaces only.
  const std::vector<ClassDescription::Interface>& interfaces() const { return description_.interfaces; }
  /// The default of a property, read from a fresh object; nil for abstract classes.
  Value defaultOf(const Property& property);

 private:
  friend class Leaf;
  friend class detail::Tree;
  /// The leaf as class or interface `id`, nullptr when it is none; once resolved.
  void* cast(Leaf* leaf, const InterfaceId& id) const {
    for (std::size_t i = id.id & castMask_; casts_[i].id; i = (i + 1) & castMask_)
      if (casts_[i].id == id.id) return casts_[i].to(leaf);
    return nullptr;
  }
  std::unique_ptr<Leaf> construct() const;
  void bindLinks(Leaf& leaf);
  void warnOfMissing(const Leaf& leaf) const;
  void fillCasts();
  void resolve();
  std::int64_t livingCount() const;
  std::string pluginName() const;

  /// Own and inherited interfaces by id, in open addressing with room for misses: queries are what tree walks spend
  /// their time on.
  struct Cast {
    std::uint64_t id = 0;
    void* (*to)(Leaf*) = nullptr;
  };

  Kernel& kernel_;
  ClassDescription description_;
  std::vector<Cast> casts_{Cast{}};
  std::uint64_t castMask_ = 0;
  std::vector<const Hook*> hooks_;
  std::vector<const LinkDescription*> links_;
  std::vector<detail::LinkSite> sites_;  ///< of each link
  std::vector<const Property*> stateProperties_;
  Plugin* plugin_;
  ClassObject* base_ = nullptr;
  bool resolved_ = false;
  std::size_t living_ = 0;
};

}  // namespace spark
