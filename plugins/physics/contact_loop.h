#pragma once
/// \file
/// One round of contacts: which pairs count, whose handlers run, what surface two colliders have together.
///
/// For each contact point the handlers of the first collider run as direct, those of the second as symmetric. A contact
/// becomes solid when a body is involved and both colliders have a handler with a surface (ContactJointHandler and what
/// derives from it; the first counts) or no handler at all (a bouncy default). Plain ContactJointHandlers are not
/// called: they have nothing to do but to be there.

#include "collider.h"

namespace spark::physics {

/// The surface of a contact of `a` with `b`: friction is the mean; each other item that one has is taken, that both
/// have averaged.
engine::Surface combine(const engine::Surface& a, const engine::Surface& b);

/// For the engine: owners are Colliders. False for pairs that are told not to collide and for those nobody would hear
/// of.
bool pairCounts(void* ownerA, void* ownerB);

/// Runs the handlers, decides what is solved. Stops early (and drops all contacts) when a handler changed the tree.
void runHandlers(engine::Contacts& contacts, Kernel& kernel);
/// Asks for the force of every contact that is solved; appends the indices of those that no handler asked for.
void measure(engine::Contacts& contacts, std::vector<std::size_t>& added);
/// Tells the handlers that asked for feedback what the solver did.
void runSolved(engine::Contacts& contacts);

}  // namespace spark::physics
