#pragma once
/// \file
/// The handling of the contacts of a step: the pair filter, the combined surface of two colliders, the calls of
/// collision handlers.
///
/// For each contact point the handlers of the first collider run as direct, those of the second as symmetric. A contact
/// is solid when a body is involved and each of the two colliders has a handler with a surface (a ContactJointHandler
/// or a class derived from it; the first counts) or no handler at all (a bouncy default). Plain ContactJointHandlers
/// are not called: they only hold a surface.

#include "collider.h"

namespace spark::physics {

/// The surface of a contact of `a` with `b` (scene-language section 3.3): mu is the mean of both; every other parameter
/// is taken from the surface that has it switched on, and is the mean where both have. For colliders of one priority.
engine::Surface combine(const engine::Surface& a, const engine::Surface& b);

/// The pair filter of the engine; owners are Colliders. False for pairs whose collisions are excluded, and for pairs
/// whose contacts would have no effect.
bool pairCounts(void* ownerA, void* ownerB);

/// Sets `solve` and `surface` of the contacts of a pair. In any thread.
void decide(std::span<engine::Contact> pair);
/// Sorts contacts by the age of their geoms; those of a pair keep their order. `order` and `sorted` are its memory.
void sortByPair(engine::Contacts& contacts, const engine::Model& model, std::vector<std::size_t>& order,
                engine::Contacts& sorted);
/// Decides on the contacts, unless they are `decided`, and calls the handlers before the solver. When a handler changes
/// the tree, it logs an error, removes all contacts and returns.
void runHandlers(engine::Contacts& contacts, Kernel& kernel, bool decided = false);
/// Sets `feedback` of every contact that is solved; appends the indices of those that did not have it to `added`.
void measure(engine::Contacts& contacts, std::vector<std::size_t>& added);
/// Calls the handlers after the solver, for contacts with `feedback`. `steps`: number of the engine's steps in one of
/// the simulation, which the forces are divided by.
void runSolved(engine::Contacts& contacts, int steps);

}  // namespace spark::physics
