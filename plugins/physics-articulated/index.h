#pragma once
/// \file
/// Indices of bodies, joints, contacts, rows, nodes and trees.

#include <cstddef>
#include <cstdint>

namespace spark::articulated {

/// Position in an array; each declaration says in which one. 32 bits, so that rows and nodes stay small.
using Index = std::uint32_t;
/// No such element.
inline constexpr Index kNone = UINT32_MAX;

/// A size or position in a container, which must be below 2^32 - 1.
constexpr Index toIndex(std::size_t i) { return static_cast<Index>(i); }

}  // namespace spark::articulated
