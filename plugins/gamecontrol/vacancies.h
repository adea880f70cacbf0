#pragma once
/// \file
/// Robots of a saved state that stand there and wait for their clients.

#include <memory>
#include <string>
#include <vector>

#include "api/match.h"
#include "gamecontrol/participant.h"

namespace spark::gamecontrol {

using Participants = std::vector<std::unique_ptr<Participant>>;

bool hasVacant(const Participants& participants);
/// The vacant participant that had this connection when the state was saved; nullptr: none.
Participant* vacantAt(const Participants& participants, IConnection& connection);
/// The vacant participant that a client names in its actions; nullptr: none.
Participant* vacantNamed(const Participants& participants, const Participant& client, IJoinPolicy& policy);
/// The vacant participant as which a client that connects goes on: an agent that its port has started again as itself,
/// another client as the player that it names; where players have no names (`policy` is nullptr), as the first one that
/// does not wait for an agent of its own. nullptr: none.
Participant* vacantFor(const Participants& participants, const Participant& client, IJoinPolicy* policy);
/// True if another client claims to be the player that `holder` is: it was told that this one is there, and waits, or
/// it names that player in its actions.
bool isClaimed(const Participants& participants, const Participant& holder, IJoinPolicy* policy);
/// Which robots wait for their clients, and what to do, for the log.
std::string reportOfVacant(const Participants& participants);
/// Robots without a name leave: their clients cannot find them, and come as new ones.
void dropNameless(const Participants& participants);

}  // namespace spark::gamecontrol
