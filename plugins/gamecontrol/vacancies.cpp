#include "gamecontrol/vacancies.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::gamecontrol {

namespace {
/// The first vacant participant that fulfils a condition.
template <class F>
Participant* firstVacant(const Participants& participants, F condition) {
  const auto found = std::find_if(participants.begin(), participants.end(),
                                  [&](const auto& p) { return p->vacant() && !p->leaving() && condition(*p); });
  return found == participants.end() ? nullptr : found->get();
}

IAgentIdentity* identityOf(const Participant& p) {
  return p.aspect() ? static_cast<IAgentIdentity*>(Below<IAgentIdentity>().find(*p.aspect())) : nullptr;
}

bool hasName(const Participant& p, const IJoinPolicy::Name& name) {
  const IAgentIdentity* const identity = identityOf(p);
  return identity && identity->number() == name.number && identity->team() == name.team;
}

/// Calls `f(name)` for each name in the actions until it returns true; true if it did.
template <class F>
bool anyName(const Predicates& actions, const IJoinPolicy& policy, F f) {
  for (const Element e : actions)
    if (e.head() == policy.predicate() && f(policy.read(e))) return true;
  return false;
}

Participant* vacantNamedIn(const Predicates& actions, const Participants& participants, IJoinPolicy& policy) {
  Participant* found = nullptr;
  anyName(actions, policy, [&](const IJoinPolicy::Name& name) {
    found = firstVacant(participants, [&name](const Participant& p) { return hasName(p, name); });
    return found != nullptr;
  });
  return found;
}
}  // namespace

bool hasVacant(const Participants& participants) {
  return std::any_of(participants.begin(), participants.end(), [](const auto& p) { return p->vacant(); });
}

Participant* vacantAt(const Participants& participants, IConnection& connection) {
  const Participant::Seat seat = Participant::Seat::of(connection);
  return firstVacant(participants, [&seat](const Participant& p) { return p.seat() == seat; });
}

Participant* vacantNamed(const Participants& participants, const Participant& client, IJoinPolicy& policy) {
  if (Participant* const player = vacantNamedIn(client.pending(), participants, policy)) return player;
  return vacantNamedIn(client.deferred(), participants, policy);  // it was held back
}

Participant* vacantFor(const Participants& participants, const Participant& client, IJoinPolicy* policy) {
  IConnection* const connection = client.connection();
  if (!connection) return nullptr;
  if (connection->port().as<IReturningAgents>()) return vacantAt(participants, *connection);
  if (policy) return vacantNamed(participants, client, *policy);
  return firstVacant(participants, [](const Participant& p) { return !p.returns(); });
}

bool isClaimed(const Participants& participants, const Participant& holder, IJoinPolicy* policy) {
  if (holder.claimed()) return true;
  if (!policy) return false;
  const auto isHolder = [&holder](const IJoinPolicy::Name& name) { return hasName(holder, name); };
  return std::any_of(participants.begin(), participants.end(), [&](const auto& p) {
    return p.get() != &holder && p->connection() && !p->leaving() &&
           (anyName(p->pending(), *policy, isHolder) || anyName(p->deferred(), *policy, isHolder));
  });
}

std::string reportOfVacant(const Participants& participants) {
  constexpr std::size_t kMostNames = 22;
  std::vector<std::string> names;
  for (const auto& p : participants) {
    if (!p->vacant() || p->leaving()) continue;
    const IAgentIdentity* const identity = identityOf(*p);
    names.push_back(identity && identity->number() > 0 ? fmt::format("{} {}", identity->team(), identity->number())
                                                       : p->label());
  }
  const std::size_t count = names.size(), more = count > kMostNames ? count - kMostNames : 0;
  names.resize(count - more);
  return fmt::format(
      "Nobody plays {} of the robots: {}{}. Their agents can come back at any time; with --expect {} the "
      "clock waits for them.",
      count, fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "",
      std::count_if(participants.begin(), participants.end(), [](const auto& p) { return !p->inside(); }));
}

void dropNameless(const Participants& participants) {
  for (const auto& p : participants) {
    if (!p->vacant()) continue;
    const IAgentIdentity* const identity = identityOf(*p);
    if (!identity || identity->number() == 0) p->leave();
  }
}

}  // namespace spark::gamecontrol
