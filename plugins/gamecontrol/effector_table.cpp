#include "gamecontrol/effector_table.h"

#include <algorithm>

#include "gamecontrol/scene_effector.h"
#include "spark/kernel.h"

namespace spark::gamecontrol {

std::size_t EffectorTable::rebuild(AgentAspect& root) {
  clear();
  structure_ = &root.kernel().structureVersion();
  std::vector<Effector*> effectors;
  root.collect(effectors);
  for (Effector* e : effectors) entries_.push_back({.predicate = e->predicate(), .effector = e});

  // Sort by predicate; of equal ones keep the last in tree order.
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.predicate < b.predicate; });
  for (std::size_t i = 0; i + 1 < entries_.size();)
    if (entries_[i].predicate == entries_[i + 1].predicate)
      entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;

  for (Entry& e : entries_) {
    if (e.effector->as<ISyncEffector>()) syncPredicate_ = e.predicate;
    auto modifiers = ModifierChain::of(*e.effector);
    if (!modifiers) continue;
    modified_.push_back(std::make_unique<Modified>(Modified{e.effector, std::move(modifiers), {}}));
    e.modified = modified_.back().get();
  }
  dropRemoved();
  return effectors.size();
}

void EffectorTable::clear() {
  entries_.clear();
  modified_.clear();
  syncPredicate_.clear();
}

void EffectorTable::dropRemoved() {
  for (Entry& e : entries_) e.called = e.effector && e.effector->isLinked() ? e.effector.get() : nullptr;
  calledAt_ = *structure_;
}

std::vector<std::string> EffectorTable::predicates() const {
  std::vector<std::string> out;
  for (const Entry& e : entries_) out.push_back(e.predicate);
  return out;
}

bool EffectorTable::loading() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Entry& e) {
    const auto scene = e.effector ? e.effector->as<SceneEffector>() : nullptr;
    return scene && scene->late();
  });
}

std::size_t EffectorTable::indexOf(std::string_view predicate) const {
  const auto it = std::lower_bound(entries_.begin(), entries_.end(), predicate,
                                   [](const Entry& e, std::string_view p) { return e.predicate < p; });
  if (it == entries_.end() || it->predicate != predicate) return entries_.size();
  return static_cast<std::size_t>(it - entries_.begin());
}

}  // namespace spark::gamecontrol
