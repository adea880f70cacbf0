#include "timers.h"

namespace spark::simulation {

void Timers::reset() {
  sums_.fill(Clock::duration::zero());
  cycles_ = 0;
}

List Timers::means() const {
  List out;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const double micros = std::chrono::duration<double, std::micro>(sums_[i]).count();
    out.push_back(List{Value(kPartNames[i]), Value(cycles_ ? micros / static_cast<double>(cycles_) : 0.0)});
  }
  return out;
}

}  // namespace spark::simulation
