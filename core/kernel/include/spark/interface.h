#pragma once
/// \file
/// Interfaces that objects of the tree implement, beside their class.

#include <cstdint>

#include "spark/abi/spark/interface.h"

namespace spark {

/// The id of a version of an interface. Each class is an interface too.
struct InterfaceId {
  const char* name;
  unsigned version;
  std::uint64_t id;  ///< FNV-1a hash of name and version
  /// The id of version `v` of the interface `n`, a literal.
  constexpr InterfaceId(const char* n, unsigned v) : name(n), version(v), id(14695981039346656037ull) {
    for (const char* c = n; *c; ++c) id = (id ^ static_cast<unsigned char>(*c)) * 1099511628211ull;
    id = (id ^ v) * 1099511628211ull;
  }
};

/// In the definition of an interface: defines its id.
#define SPARK_INTERFACE(Name, Version) \
  static constexpr ::spark::InterfaceId kInterface { #Name, Version }

/// In the definition of a class: defines its name in the tree and its base. SPARK_PLUGIN checks at compile time that
/// both agree with the class.
#define SPARK_CLASS(Self, Base)                               \
 public:                                                      \
  static constexpr const char* kClassName = #Self;            \
  using ClassSelf = Self;                                     \
  using ClassBase = Base;                                     \
  static constexpr ::spark::InterfaceId kInterface{#Self, 1}; \
                                                              \
 private:

namespace detail {
/// An interface of a server with a well-known path.
template <class T>
concept HasPath = requires {
  T::kPath;
};
}  // namespace detail

}  // namespace spark
