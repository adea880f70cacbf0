#include "gamecontrol/judges.h"

#include "spark/state.h"

namespace spark {

void RequestAspect::saveState(StateWriter& out) const {
  out.write(static_cast<std::int64_t>(refused_.size()));
  for (const auto& [agent, count] : refused_) {
    out.write(agent);
    out.write(count);
  }
}

void RequestAspect::loadState(StateReader& in) {
  refused_.clear();
  for (std::int64_t n = in.readInteger(); n > 0; --n) {
    const auto agent = static_cast<int>(in.readInteger());
    refused_[agent] = static_cast<int>(in.readInteger());
  }
}

}  // namespace spark
