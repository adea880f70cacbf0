#pragma once
/// \file
/// What a class says about itself: properties, methods, hooks, links.
///
/// One table serves Lua, scene files, sparkctl, `--describe` and state. It is filled by `describe()` (see describe.h).

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

}  // namespace spark
