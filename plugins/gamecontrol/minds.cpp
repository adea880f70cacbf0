#include "gamecontrol/minds.h"

#include <algorithm>

namespace spark::gamecontrol {

bool Minds::isExcluded(const Behavior& mind) const {
  return std::find(excluded_.begin(), excluded_.end(), mind.id()) != excluded_.end();
}

bool Minds::isKnown(const Behavior& mind) const {
  const auto drives = [&mind](const auto& p) { return p->behavior() == &mind; };
  return std::any_of(participants_.begin(), participants_.end(), drives) || isExcluded(mind);
}

/// The aspect that a mind outside of /usr/agent drives: that of an object, or a rule; nullptr: it drives nothing.
AgentAspect* Minds::aspectFor(Behavior& mind) const {
  auto* const aspect = mind.ancestor<AgentAspect>();
  if (!aspect) return nullptr;
  const auto drives = [aspect](const auto& p) { return p->aspect() == aspect && !p->leaving(); };
  if (std::any_of(participants_.begin(), participants_.end(), drives)) return nullptr;
  // In a robot only the outermost aspect is an agent's. Rules may have others above them.
  const bool outermost = &aspect->outermost() == aspect;
  return aspect->as<ControlAspect>() || outermost ? aspect : nullptr;
}

void Minds::join(Node& control, const Join& join) {
  if (!tree_.isStale(control)) return;
  Node& root = control.kernel().root();
  std::vector<Behavior*> minds;
  if (auto* home = root.find<Node>("/usr/agent")) home->collect(minds);
  const std::size_t atHome = minds.size();
  auto* const server = root.find<ISceneServer>();
  if (Node* const scene = server ? server->activeScene() : nullptr) scene->collect(minds);
  root.collect(minds);  // in scenes that are not active, and of rules

  // One that starts may be a script, which removes others.
  const std::vector<Ref<Behavior>> joining(minds.begin(), minds.end());
  for (std::size_t i = 0; i < joining.size(); ++i) {
    Behavior* const mind = joining[i].get();
    if (!mind || isKnown(*mind)) continue;
    auto* const aspect = i < atHome ? nullptr : aspectFor(*mind);
    if (i >= atHome && !aspect) continue;
    const std::uint64_t id = mind->id();
    if (!join(*mind, aspect)) excluded_.push_back(id);
  }

  for (const Ref<Behavior>& mind : joining)
    if (mind && !isKnown(*mind))
      idle_.report(
          *mind,
          "drives nothing: expected it below /usr/agent, or as the only mind below a rule or below the AgentAspect "
          "of an object");
  idle_.reportEffectors(control);
  tree_.changed(control);  // ignore the changes that joining made
}

std::string Minds::excluded(const Node& root) const {
  std::vector<Behavior*> all;
  root.collect(all);
  std::string out;
  for (const Behavior* mind : all)
    if (isExcluded(*mind)) out += mind->path() + "\n";
  return out;
}

void Minds::setExcluded(std::string_view paths, const Node& root) {
  excluded_.clear();
  for (std::size_t end; (end = paths.find('\n')) != paths.npos; paths.remove_prefix(end + 1))
    if (const auto* const mind = root.find<Behavior>(paths.substr(0, end))) exclude(*mind);
}

}  // namespace spark::gamecontrol
