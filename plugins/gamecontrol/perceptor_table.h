#pragma once
/// \file
/// The perceptors of one agent.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/agents.h"
#include "gamecontrol/agent_log.h"
#include "gamecontrol/modifier_chain.h"

namespace spark::gamecontrol {

/// Calls the perceptors that are due and applies their modifiers. A perceptor that throws is not
/// called again; one that leaves lists open is reported, and the lists are closed so that they do not swallow other
/// percepts.
class PerceptorTable {
 public:
  /// Collects the perceptors below `root`. Returns their number.
  std::size_t rebuild(AgentAspect& root);
  /// Removes all perceptors.
  void clear();
  /// Forgets perceptors that were removed from the tree. Call it after a change of the tree and before share().
  void dropRemoved();

  /// Updates what the due perceptors share with others (ISharedView). Sense phase, simulation thread, before any
  /// sense(). `round`: number of the sense phase; `cycle`: the agent's cycle count.
  void share(std::uint64_t round, std::int64_t cycle);
  /// Adds the percepts of the perceptors that are due in the agent's `cycle` to `out`, which is empty. Any thread;
  /// changes only this agent. False if there is something for reportFaults().
  bool sense(Predicates& out, const Event& event, std::int64_t cycle);
  /// Reports a perceptor that threw and removes it; reports one that left lists open, once each. Simulation thread.
  /// `label`: the agent, for the log.
  void reportFaults(std::string_view label, AgentLog& log);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  struct Sensor {
    Ref<Perceptor> perceptor;
    std::unique_ptr<ModifierChain> modifiers;  ///< nullptr: none
  };
  /// A sensor as pointers, valid until the tree changes: a Ref costs a cache line.
  struct Called {
    Perceptor* perceptor;
    const ModifierChain* modifiers;
  };
  struct Shared {
    Ref<Perceptor> perceptor;
    ISharedView* view;
    const Perceptor* called;  ///< as in `called_`
  };
  static bool isDue(const Perceptor& p, std::int64_t cycle) { return cycle % std::max(1, p.interval()) == 0; }
  /// Calls `run`, which adds percepts to `out` from token `first` on. If it throws, these are removed and the perceptor
  /// with that index is noted.
  template <class F>
  void guard(std::size_t perceptor, Predicates& out, std::uint32_t first, F run);
  void closeLists(std::size_t perceptor, Predicates& out);

  std::vector<Sensor> sensors_;  ///< in tree order
  std::vector<Called> called_;   ///< the same
  std::vector<Shared> shared_;   ///< perceptors that offer ISharedView

  std::size_t faulty_ = kNone;           ///< index of a perceptor that threw
  std::string fault_;                    ///< what it threw
  std::size_t unbalanced_ = kNone;       ///< index of a perceptor whose lists were closed
  int openLists_ = 0;                    ///< what Predicates::balance() returned for them
  std::vector<std::uint64_t> reported_;  ///< ids of the perceptors that were reported for open lists
};

}  // namespace spark::gamecontrol
