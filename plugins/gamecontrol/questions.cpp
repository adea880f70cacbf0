#include "gamecontrol/questions.h"

#include <algorithm>

#include "gamecontrol/modifier_chain.h"
#include "gamecontrol/script_event.h"
#include "gamecontrol/script_perceptor.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark::gamecontrol {

List Questions::ask(Node& node, std::uint64_t round, const std::function<bool(const Perceptor&)>& isSensed) {
  if (asking_) throw Error("a perceptor that is asked cannot ask others");
  std::vector<Perceptor*> perceptors;
  if (const auto self = node.as<Perceptor>()) perceptors.push_back(self);
  node.collect(perceptors);
  perceptors.erase(std::unique(perceptors.begin(), perceptors.end()), perceptors.end());
  const std::vector<Ref<Perceptor>> all(perceptors.begin(), perceptors.end());
  const Event event = eventNow(node.kernel().root().find<ISimulation>());
  struct Asking {
    bool& on;
    explicit Asking(bool& flag) : on(flag) { on = true; }
    ~Asking() { on = false; }
  } asking(asking_);

  Predicates out;
  for (const Ref<Perceptor>& perceptor : all) {
    if (!perceptor) continue;  // a perceptor that is a script removed it
    NowRunning now("sense", perceptor.get());
    StateWriter before(true);
    saveTree(*perceptor, before);
    const auto restore = [&] {
      if (!perceptor) return;
      StateReader then(before.bytes());
      loadTree(*perceptor, then);
    };
    try {
      const auto first = out.size();
      const bool keepsLast = perceptor->as<ScriptPerceptor>() && isSensed(*perceptor);
      if (const auto view = perceptor->as<ISharedView>(); view && !keepsLast) view->share(round);
      if (perceptor) perceptor->sense(out, event);
      if (const auto modifiers = perceptor ? ModifierChain::of(*perceptor) : nullptr)
        modifiers->apply({Signal::Kind::percept, out, first}, event, now);
    } catch (...) {
      restore();
      throw;
    }
    restore();
  }
  return toList(out);
}

}  // namespace spark::gamecontrol
