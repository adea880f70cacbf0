#pragma once
/// \file
/// The description of a class: properties, methods, hooks, links. Lua, scene files, sparkctl, `--describe` and saved
/// state all use it. A class fills it in its `describe()` (describe.h).

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "spark/abi/spark/class_description.h"
#include "spark/leaf.h"
#include "spark/link.h"
#include "spark/value.h"

namespace spark {

struct Event;

/// A value of an object that can be read, and usually written, by its name. A property `x` also makes the method
/// `getX`, and `setX` if it is writable.
struct Property {
  std::string name;
  std::string type;                  ///< as Convert<T>::typeName: "number", "string", "vec3 [m]", ...
  std::string unit;                  ///< "m", "rad/s", ...; "" for none
  std::string doc;                   ///< one sentence
  std::optional<double> min, max;    ///< range of each number in it, inclusive; empty: no limit
  std::vector<std::string> choices;  ///< the only texts allowed; empty: any
  int scalars = 1;                   ///< plain arguments that `set` reads, -1 for any number
  bool readOnly = false;
  bool state = false;                     ///< part of the state hash and of saved state
  bool savedByClass = false;              ///< part of what saveState() saves, or follows from it
  bool ofProcess = false;                 ///< tells of this process, such as a count since its start
  std::function<Value(const Leaf&)> get;  ///< reads it
  std::function<void(Leaf&, Args&)> set;  ///< writes it, without checks of range and choices; empty if read only

  /// True if its value is in the hash of the configuration.
  bool isConfiguration() const { return !readOnly && !state && !savedByClass && !ofProcess && name != "name"; }
};

/// A method that can be called by its name.
struct Method {
  std::string name;
  std::string doc;                          ///< one sentence
  std::vector<std::string> parameters;      ///< "name: type [unit]" each
  std::string returns;                      ///< type name, "" for nothing; "@name" for an alias of method `name`
  int minScalars = 0;                       ///< plain arguments that it needs
  int maxScalars = 0;                       ///< plain arguments that it reads, -1 for any number
  bool surplusIgnored = false;              ///< scene files may pass more than maxScalars
  std::function<Value(Leaf&, Args&)> call;  ///< calls it; empty for an alias
};

/// A handler that every object of a class has while it is linked.
struct Hook {
  std::string channel;
  void (*run)(Leaf&, const Event&) = nullptr;
};

/// A link that every object of a class has.
struct LinkDescription {
  AnyRoute route;
  bool all = false;                                ///< it is a Links: it leads to all matches of the route
  std::string doc;                                 ///< one sentence, may be empty
  std::string lacks;                               ///< the end of the warning if there is no target; "": no warning
  std::function<detail::LinkBase&(Leaf&)> member;  ///< the link of an object
  /// The objects to which the route leads from `owner` now.
  std::vector<Found<void>> targets(const Leaf& owner) const;
};

/// The description of a class.
struct ClassDescription {
  /// An interface, and the cast from an object of the class.
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
  std::unique_ptr<Leaf> (*make)() = nullptr;  ///< constructs an object; nullptr if the class is abstract
};

/// For ClassDescription::make: objects of the class are made as those of its base, and the class only describes them in
/// another way. Not to be called.
std::unique_ptr<Leaf> makeAsBase();

}  // namespace spark
