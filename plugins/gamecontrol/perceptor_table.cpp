#include "gamecontrol/perceptor_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "spark/prefetch.h"
#include "spark/running.h"

namespace spark::gamecontrol {

namespace {
// The solver has displaced perceptors, and the joints above them, from the CPU caches.
constexpr std::size_t kFar = 4;      // prefetch distance of perceptors
constexpr std::size_t kNear = 2;     // prefetch distance of what is above them
constexpr std::size_t kBytes = 320;  // of each, that most read
}  // namespace

std::size_t PerceptorTable::rebuild(AgentAspect& root) {
  shared_.clear();
  std::vector<Perceptor*> perceptors;
  root.collect(perceptors);
  sensors_.clear();
  for (Perceptor* p : perceptors) {
    sensors_.push_back({p, ModifierChain::of(*p)});
    if (auto view = p->as<ISharedView>()) shared_.push_back({p, view, p});
  }
  dropRemoved();
  return sensors_.size();
}

void PerceptorTable::clear() {
  sensors_.clear();
  shared_.clear();
  called_.clear();
}

void PerceptorTable::dropRemoved() {
  std::erase_if(sensors_, [](const Sensor& s) { return !s.perceptor; });
  std::erase_if(shared_, [](const Shared& s) { return !s.perceptor; });
  called_.clear();
  for (const Sensor& s : sensors_) called_.push_back({s.perceptor.get(), s.modifiers.get()});
}

void PerceptorTable::share(std::uint64_t round, std::int64_t cycle) {
  if (shared_.empty()) return;
  NowRunning now("share");
  for (const Shared& s : shared_)
    if (s.perceptor && isDue(*s.called, cycle)) now.at(s.called), s.view->share(round);
}

bool PerceptorTable::sense(Predicates& out, const Event& event, std::int64_t cycle) {
  NowRunning now("sense");
  for (std::size_t i = 0; i < called_.size(); ++i) {
    if (i + kFar < called_.size()) prefetch(called_[i + kFar].perceptor, kBytes);
    if (i + kNear < called_.size()) prefetch(called_[i + kNear].perceptor->parent(), kBytes);
    const Called& c = called_[i];
    const std::uint32_t first = out.size();
    if (isDue(*c.perceptor, cycle)) {
      now.at(c.perceptor);
      guard(i, out, first, [&] { c.perceptor->sense(out, event); });
    }
    if (c.modifiers) guard(i, out, first, [&] { c.modifiers->apply({Signal::Kind::percept, out, first}, event, now); });
  }
  return faulty_ == kNone && unbalanced_ == kNone;
}

/// No exception may leave a worker thread: it would end the process.
template <class F>
void PerceptorTable::guard(std::size_t perceptor, Predicates& out, std::uint32_t first, F run) {
  try {
    run();
  } catch (const std::exception& fault) {
    out.truncate(first);
    faulty_ = perceptor;
    fault_ = fault.what();
  } catch (...) {
    out.truncate(first);
    faulty_ = perceptor;
    fault_ = "something that is no std::exception";
  }
  if (out.isUnbalanced()) [[unlikely]]
    closeLists(perceptor, out);
}

void PerceptorTable::closeLists(std::size_t perceptor, Predicates& out) {
  const int open = out.balance();
  const std::uint64_t id = called_[perceptor].perceptor->id();
  if (unbalanced_ != kNone || std::find(reported_.begin(), reported_.end(), id) != reported_.end()) return;
  reported_.push_back(id);
  unbalanced_ = perceptor;
  openLists_ = open;
}

void PerceptorTable::reportFaults(std::string_view label, AgentLog& log) {
  if (const Perceptor* p = unbalanced_ != kNone ? sensors_[unbalanced_].perceptor.get() : nullptr)
    log.write(Level::error, fmt::format("{}: {} ({}) {} in sense(); its percept is as if it had closed what it opened. "
                                        "Each open() needs one close(). This is reported once.",
                                        label, p->path(), p->classObject()->name(),
                                        openLists_ > 0 ? fmt::format("left {} list(s) open", openLists_)
                                                       : std::string("closed a list that was not open")));
  unbalanced_ = kNone;

  if (faulty_ == kNone) return;
  if (const Perceptor* p = sensors_[faulty_].perceptor.get()) {
    p->kernel().countFault();
    log.write(Level::error, fmt::format("{}: {} ({}) threw and is asked no more: {}", label, p->path(),
                                        p->classObject()->name(), fault_));
  }
  sensors_.erase(sensors_.begin() + static_cast<std::ptrdiff_t>(faulty_));
  called_.erase(called_.begin() + static_cast<std::ptrdiff_t>(faulty_));
  faulty_ = kNone;
}

}  // namespace spark::gamecontrol
