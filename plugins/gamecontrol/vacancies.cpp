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

Participant* vacantNamedIn(const Predicates& actions, const Participants& participants, IJoinPolicy& policy) {
  for (const Element e : actions) {
    if (e.head() != policy.predicate()) continue;
    const IJoinPolicy::Name name = policy.read(e);
    Participant* const found = firstVacant(participants, [&name](const Participant& p) {
      const IAgentIdentity* const identity = identityOf(p);
      return identity && identity->number() == name.number && identity->team() == name.team;
    });
    if (found) return found;
  }
  return nullptr;
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
