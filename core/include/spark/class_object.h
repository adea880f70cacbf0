#pragma once
/// \file
/// Class objects: reflective factories in the tree (`/classes/<Name>`) that know base, interfaces, properties, methods
/// and hooks.
///
/// One table serves Lua, scene files, sparkctl, `--describe` and state. It is filled by `describe()` (see describe.h).

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spark/abi/spark/class_object.h"
#include "spark/link.h"
#include "spark/node.h"
#include "spark/value.h"

namespace spark {

struct Event;
class Plugin;
template <class T>
class Description;

/// One readable, usually writable value of a class. A writable property `x` also gives the methods `setX` and `getX`.
struct Property {
  std::string name;
  std::string type;                  ///< "number", "string", "vec3 [m]", ... as Convert<T>::typeName says
  std::string unit;                  ///< "m", "rad/s", "" when it has none
  std::string doc;                   ///< one sentence
  std::optional<double> min, max;    ///< inclusive range of every number in it
  std::vector<std::string> choices;  ///< when not empty: the only texts allowed
  int scalars = 1;                   ///< plain arguments that set takes, -1 for any number
  bool readOnly = false;
  bool state = false;  ///< part of the state hash and of saved state
  std::function<Value(const Leaf&)> get;
  std::function<void(Leaf&, Args&)> set;  ///< empty when read only
};

/// One callable of a class.
struct Method {
  std::string name;
  std::string doc;
  std::vector<std::string> parameters;  ///< "name: type [unit]" each
  std::string returns;                  ///< type name, "" for nothing
  int minScalars = 0;                   ///< plain arguments needed
  int maxScalars = 0;                   ///< plain arguments taken, -1 for any number
  bool surplusIgnored = false;          ///< loose callers may pass more than maxScalars
  std::function<Value(Leaf&, Args&)> call;
};

/// A handler that every object of the class has from link to unlink.
struct Hook {
  std::string channel;
  void (*run)(Leaf&, const Event&) = nullptr;
};

/// A link that every object of the class has.
struct LinkDescription {
  AnyRoute route;
  bool all = false;   ///< Links: it leads to all that the route finds
  std::string doc;    ///< one sentence, may be empty
  std::string lacks;  ///< not empty: without a target a warning says so, and this
  std::function<detail::LinkBase&(Leaf&)> member;
  /// Where it leads from an object of the class now.
  std::vector<Found<void>> targets(const Leaf& owner) const;
};

/// What `describe()` fills in.
struct ClassDescription {
  struct Interface {
    InterfaceId id;
    void* (*cast)(Leaf*);
  };
  std::string name, base, doc;
  std::vector<Interface> interfaces;
  std::vector<Property> properties;
  std::vector<Method> methods;
  std::vector<Hook> hooks;
  std::vector<LinkDescription> links;
  std::unique_ptr<Leaf> (*make)() = nullptr;  ///< nullptr: abstract
};

/// A class in the tree. Made by plugins that register, gone when their plugin goes.
class ClassObject : public Leaf {
 public:
  ClassObject(ClassDescription description, Plugin* plugin);
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
  friend class Kernel;
  friend class Loader;
  friend class Node;
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

  ClassDescription description_;
  std::vector<Cast> casts_{Cast{}};
  std::uint64_t castMask_ = 0;
  Kernel* kernel_ = nullptr;
  std::vector<const Hook*> hooks_;
  std::vector<const LinkDescription*> links_;
  std::vector<detail::LinkSite> sites_;  ///< of each link
  std::vector<const Property*> stateProperties_;
  Plugin* plugin_;
  ClassObject* base_ = nullptr;
  bool resolved_ = false;
  std::size_t living_ = 0;
};

/// Reads or writes a property by name, calls a method by name. Throws Error: unknown name (with the nearest), wrong
/// type or count, out of range.
Value getProperty(const Leaf& leaf, std::string_view name);
void setProperty(Leaf& leaf, std::string_view name, const Value& value);
Value callMethod(Leaf& leaf, std::string_view name, std::span<const Value> arguments);
/// As callMethod for a method already found. `loose`: conversions and counts as the installed base's scene files have
/// them; returns false (and does nothing) where the original silently ignored the call.
bool callLoosely(Leaf& leaf, const Method& method, std::span<const Value> arguments, std::string& whyNot);

}  // namespace spark
