#include "gamecontrol/modifier_chain.h"

#include <fmt/format.h>

#include "spark/error.h"

namespace spark::gamecontrol {

std::unique_ptr<ModifierChain> ModifierChain::of(const Node& owner) {
  std::unique_ptr<ModifierChain> chain;
  for (const auto& child : owner.children())
    if (Modifier* m = child->as<Modifier>()) {
      if (!chain) chain = std::make_unique<ModifierChain>();
      chain->modifiers_.emplace_back(m);
    }
  return chain;
}

void ModifierChain::apply(Signal signal, const Event& event, NowRunning& now) const {
  for (const Ref<Modifier>& ref : modifiers_) {
    Modifier* const m = ref.get();
    if (!m) continue;  // removed since the chain was made
    now.at(m);
    const auto fail = [m](const char* what) {
      throw Error(fmt::format("its modifier {} ({}) threw: {}", m->name(), m->classObject()->name(), what));
    };
    try {
      m->apply(signal, event);
    } catch (const std::exception& fault) {
      fail(fault.what());
    } catch (...) {
      fail("something that is no std::exception");
    }
  }
}

}  // namespace spark::gamecontrol
