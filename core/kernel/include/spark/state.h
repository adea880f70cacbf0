#pragma once
/// \file
/// The state of a simulation: what the kernel keeps (Kernel::saveState()), then for each object in tree order the
/// values of all properties marked `state()`, those of bases first, followed by what saveState() writes. Names, classes
/// and the shape of the tree are not part of it, so it can be loaded only into a tree of the same shape.
///
/// All else that decides what a simulation does is its configuration: shape, classes, names, the properties that can be
/// set and are not state, and the texts that it was made of (Sources).

#include <cstdint>

#include "spark/abi/spark/state.h"
#include "spark/state_stream.h"

namespace spark {

class Leaf;

/// The hash of the state of `root` and all its descendants.
std::uint64_t stateHash(const Leaf& root);
/// The hash of the configuration of a linked `root` and its descendants, and of the kernel's sources. Of the whole tree
/// it leaves out /classes, /plugins and /sys/host: what the program shows of a run.
std::uint64_t configurationHash(const Leaf& root);
/// Writes the state of `root` and all its descendants.
void saveTree(const Leaf& root, StateWriter& out);
/// Reads the state that saveTree() wrote for a tree of the same shape. Throws Error if it does not fit; a part of the
/// tree is then changed.
void loadTree(Leaf& root, StateReader& in);

}  // namespace spark
