#pragma once
/// \file
/// Class objects: reflective factories in the tree (`/classes/<Name>`) with base class, interfaces, properties,
/// methods, hooks and links.

#include <memory>
#include <string>
#include <vector>

#include "spark/abi/spark/class_object.h"
#include "spark/access.h"
#include "spark/class_description.h"
#include "spark/leaf.h"

namespace spark {

class Plugin;

/// A class in the tree. It is made when its plugin is registered and destroyed when the plugin is unloaded.
class ClassObject : public Leaf {
 public:
  /// Made by the kernel only. `plugin` nullptr: the class is part of the program.
  ClassObject(Kernel& kernel, ClassDescription description, Plugin* plugin);
  ~ClassObject() override;
  // As SPARK_CLASS(ClassObject, Leaf), but for the name.
  static constexpr const char* kClassName = "Class";
  using ClassSelf = ClassObject;
  using ClassBase = Leaf;
  static constexpr InterfaceId kInterface{"Class", 1};
  /// Describes the class of class objects.
  static void describe(Description<ClassObject>& d);

  /// One sentence about the class.
  const std::string& doc() const { return description_.doc; }
  /// The name of the base class, "" for Leaf.
  const std::string& baseName() const { return description_.base; }
  /// True if the class is abstract: only a base, without objects of its own.
  bool isAbstract() const { return !description_.make; }
  /// The plugin that registered the class; nullptr for classes of the program itself.
  Plugin* plugin() const { return plugin_; }
  /// The number of existing objects of exactly this class.
  std::size_t living() const { return living_; }

  /// Makes an object that is not part of the tree yet. Throws Error if the class is abstract, if a base is not
  /// registered (with the plugin that provides it), or if the constructor throws.
  std::unique_ptr<Leaf> create();
  /// The class object of the base; nullptr for Leaf, and while the base is not registered.
  ClassObject* base();
  /// True if `className` is this class or one of its bases.
  bool isA(std::string_view className);
  /// True if `name` is this class, one of its bases, or an interface of one of them.
  bool isOrOffers(const std::string& name);
  /// The property of that name, own or inherited; nullptr if there is none. A derived class overrides its bases.
  const Property* property(std::string_view name);
  /// The method of that name, own or inherited, with setters, getters and aliases; nullptr if there is none. A derived
  /// class overrides its bases.
  const Method* method(std::string_view name);
  /// The property that a method of that name sets, own or inherited: `setX` sets `x`. nullptr if the name is no
  /// setter's.
  const Property* propertySetBy(std::string_view methodName);
  /// All properties, those of bases first, in order of description.
  std::vector<const Property*> properties();
  /// All methods, those of bases first, in order of description.
  std::vector<const Method*> methods();
  /// All hooks, those of bases first, in order of description.
  const std::vector<const Hook*>& hooks();
  /// All links, those of bases first, in order of description.
  const std::vector<const LinkDescription*>& links();
  /// All properties that are state, in the order of properties().
  const std::vector<const Property*>& stateProperties();
  /// The interfaces that the class itself adds to those of its bases.
  const std::vector<ClassDescription::Interface>& interfaces() const { return description_.interfaces; }
  /// The default of a property, read from a new object; nil for abstract classes.
  Value defaultOf(const Property& property);

 private:
  friend class Leaf;
  friend class detail::Tree;
  /// An object of this class as class or interface `id`; nullptr if it has no such interface.
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
  std::vector<std::string> interfaceNames();
  TableValue propertyTables();
  TableValue methodTables();

  /// An entry of the table of own and inherited interfaces: open addressing by id, at most a quarter full, because
  /// walks through the tree spend most of their time on queries, and most queries fail.
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
  std::vector<detail::LinkSite> sites_;  ///< of each of links_
  std::vector<const Property*> stateProperties_;
  Plugin* plugin_;
  ClassObject* base_ = nullptr;
  bool resolved_ = false;  ///< the lists with inherited entries are filled
  std::size_t living_ = 0;
};

}  // namespace spark
