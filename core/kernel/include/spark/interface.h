#pragma once
/// \file
/// Interfaces of the tree: what an object offers, apart from what it is.

#include <cstdint>

#include "spark/abi/spark/interface.h"

namespace spark {

/// A versioned interface id. Two ids are equal when name and version are; the number is a hash of both.
struct InterfaceId {
  const char* name;
  unsigned version;
  std::uint64_t id;
  constexpr InterfaceId(const char* n, unsigned v) : name(n), version(v), id(14695981039346656037ull) {
    for (const char* c = n; *c; ++c) id = (id ^ static_cast<unsigned char>(*c)) * 1099511628211ull;
    id = (id ^ v) * 1099511628211ull;
  }
};

/// In an interface's definition: gives it its id.
#define SPARK_INTERFACE(Name, Version) \
  static constexpr ::spark::InterfaceId kInterface { #Name, Version }

/// In a class's definition: its name in the tree and its base. The compiler checks the rest when the plugin registers
/// it.
#define SPARK_CLASS(Self, Base)                               \
 public:                                                      \
  static constexpr const char* kClassName = #Self;            \
  using ClassSelf = Self;                                     \
  using ClassBase = Base;                                     \
  static constexpr ::spark::InterfaceId kInterface{#Self, 1}; \
                                                              \
 private:

namespace detail {
/// An interface that one server offers, at a place where everybody finds it.
template <class T>
concept HasPath = requires {
  T::kPath;
};
}  // namespace detail

}  // namespace spark
