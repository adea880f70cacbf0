#pragma once
/// \file
/// Where a tree differs from saved state.

#include <string>
#include <string_view>

namespace spark {
class Leaf;
}

namespace spark::recorder {

/// The first node in tree order whose state is another one than in `saved`, which saveTree() wrote for a tree of that
/// shape, and the property: "/usr/scene/box/body.velocity: 1 against 2 in the recording". "" if nothing differs.
std::string firstDifference(const Leaf& root, std::string_view saved);

}  // namespace spark::recorder
