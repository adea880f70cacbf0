#include "gamecontrol/participant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gamecontrol/scene_effector.h"
#include "spark/prefetch.h"
#include "spark/running.h"

namespace spark::gamecontrol {

namespace {
// Tokens are larger than the bytes they come from.
constexpr std::uint32_t kMaxPendingTokens = 1 << 17;
// What a client sent may stand in a line, but not at any length.
constexpr std::size_t kLongestLine = 300;
constexpr std::size_t kAhead = 4;  // effectors or perceptors
constexpr double kSmoothed = 16;   // answers
constexpr const char* kNoException = "something that is no std::exception";
constexpr std::size_t kPart = 256, kPerceptor = 448, kAbove = 768,
                      kBuffer = 256;  // bytes, as far as they are looked at in most cycles
}  // namespace

Participant::Participant(IConnection& connection)
    : label_(fmt::format("agent at {}", connection.peer())), connection_(&connection), inside_(false) {}

Participant::Participant(Behavior& behavior)
    : label_(fmt::format("agent of {}", behavior.path())), behavior_(&behavior), inside_(true) {}

void Participant::join(int number, AgentAspect& aspect) {
  number_ = number;
  aspect_ = &aspect;
  joinedAt_ = Clock::now();
  label_ = fmt::format("agent {} ({})", number, inside_ ? behavior()->path() : connection_->peer());
  if (inside_) behavior()->start(pending_);
}

void Participant::resolveParser(Node& gameControl) {
  if (inside_ || !connection_) return;
  const Route<IParser> child = Child<IParser>();
  const Found<IParser> own = child.find(connection_->port());
  parser_ = own ? own : child.find(gameControl);
}

void Participant::warn(AgentLines& log, std::int64_t cycle, std::string_view text) {
  if (!budget_.take(cycle)) return;
  if (const auto n = budget_.leftOut())
    log.write(Level::warning, fmt::format("{}: {} further lines were left out.", label_, n));
  log.write(Level::warning,
            fmt::format("{}: {}{}", label_, text.substr(0, kLongestLine), text.size() > kLongestLine ? " ..." : ""));
}

std::string Participant::receive(std::string_view message, std::size_t maxPending, AgentLines& log,
                                 std::int64_t cycle) {
  heardFrom_ = true;
  lastHeard_ = Clock::now();
  noteAnswer();
  pendingBytes_ += message.size();
  if (pendingBytes_ > maxPending || pending_.size() + later_.size() > kMaxPendingTokens)
    return fmt::format("it sent more than {} bytes within one cycle", maxPending);
  if (!parser()) return "there is no parser below its port or below game control";
  arrived_.clear();
  const ReadResult result = parser()->parse(message, arrived_);
  if (!result.message.empty())
    warn(log, cycle,
         fmt::format("{} at {}:{}; the rest of that message is ignored.", result.message, result.line, result.column));
  for (const Element e : arrived_) synced_ |= isSync(e.head());
  pledged_ |= synced_;
  if (pending_.empty() && !holdingBack_ && number_ > 0)
    std::swap(pending_, arrived_);
  else
    keep(arrived_);
  return {};
}

void Participant::noteAnswer() {
  if (askedAt_ == Clock::time_point()) return;
  const double took = std::chrono::duration<double>(lastHeard_ - askedAt_).count();
  latency_ = std::isnan(latency_) ? took : latency_ + (took - latency_) / kSmoothed;
  askedAt_ = {};
}

bool Participant::isSync(std::string_view predicate) const {
  return predicate == (hadRobot_ ? std::string_view(syncPredicate_) : kSync) && !predicate.empty();
}

void Participant::keep(const Predicates& arrived) {
  for (const Element e : arrived)
    if (e.isList()) (holdingBack_ && e.head() != first_ ? later_ : pending_).append(e);
}

void Participant::holdBack(std::string_view first, bool expected) {
  expected_ = expected;
  holdingBack_ = true;
  first_ = first;
  arrived_.clear();
  std::swap(arrived_, pending_);
  keep(arrived_);
}

bool Participant::resolveRobot() {
  AgentAspect* root = aspect();
  const std::uint64_t changedAt = root ? root->changedAt() : 0;
  if (std::exchange(robotAt_, changedAt) == changedAt) return false;
  perceptors_.clear();
  shared_.clear();
  if (!root) {
    asked_.clear();
    effectors_.clear();
    syncPredicate_.clear();
    return false;
  }
  const std::size_t effectors = resolveEffectors(*root);
  std::vector<Perceptor*> perceptors;
  root->collect(perceptors);
  perceptors_.assign(perceptors.begin(), perceptors.end());
  for (Perceptor* p : perceptors)
    if (auto view = p->as<ISharedView>()) shared_.push_back({p, view, p});
  forgetTheDead();
  const bool first = !hadRobot_ && (!perceptors_.empty() || effectors > 1);
  hadRobot_ |= first;
  return first;
}

void Participant::forgetTheDead() {
  std::erase_if(perceptors_, [](const Ref<Perceptor>& p) { return !p; });
  std::erase_if(shared_, [](const Shared& s) { return !s.perceptor; });
  asked_.clear();
  for (const Ref<Perceptor>& p : perceptors_) asked_.push_back(p.get());
}

/// How many there are.
std::size_t Participant::resolveEffectors(AgentAspect& root) {
  std::vector<Effector*> found;
  root.collect(found);
  effectors_.clear();
  syncPredicate_.clear();
  for (Effector* e : found) effectors_.push_back({e->predicate(), e, e});
  // Of equal predicates the last in tree order counts.
  std::stable_sort(effectors_.begin(), effectors_.end(),
                   [](const Slot& a, const Slot& b) { return a.predicate < b.predicate; });
  for (std::size_t i = 0; i + 1 < effectors_.size();)
    if (effectors_[i].predicate == effectors_[i + 1].predicate)
      effectors_.erase(effectors_.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  for (const Slot& s : effectors_)
    if (s.effector->as<ISyncEffector>()) syncPredicate_ = s.predicate;
  return found.size();
}

Participant::Slot* Participant::slot(std::string_view predicate, std::size_t& guess) {
  if (guess < effectors_.size() && effectors_[guess].predicate == predicate) return &effectors_[guess];
  const auto it = std::lower_bound(effectors_.begin(), effectors_.end(), predicate,
                                   [](const Slot& s, std::string_view p) { return s.predicate < p; });
  if (it == effectors_.end() || it->predicate != predicate) return nullptr;
  guess = static_cast<std::size_t>(it - effectors_.begin());
  return &*it;
}

bool Participant::loading() const {
  return !hadRobot_ && std::any_of(effectors_.begin(), effectors_.end(), [](const Slot& s) {
    const auto scene = s.effector ? s.effector->as<SceneEffector>() : nullptr;
    return scene && scene->late();
  });
}

/// Fetches an effector. Returns the index of the one that was addressed after it in the last message.
std::size_t Participant::fetchNext(std::size_t index) const {
  if (index >= effectors_.size()) return index;
  prefetch(effectors_[index].node, kPart);
  return effectors_[index].next;
}

void Participant::approachSharing() const {
  for (const Shared& s : shared_) prefetch(s.alive, kPerceptor);
}

void Participant::approachActing() const {
  if (firstSlot_ < effectors_.size()) prefetch(&effectors_[firstSlot_], sizeof(Slot));
  prefetch(pending_.tokens().data(), kBuffer);
}

void Participant::realise(AgentLines& log, std::int64_t cycle) {
  synced_ = false;
  // The cycle in which an agent connects only makes its aspect.
  if (skipCycle_) {
    skipCycle_ = false;
    return;
  }
  if (loading()) return;  // what it says meanwhile is for the robot
  std::size_t* guess = &firstSlot_;
  std::size_t ahead = firstSlot_;
  for (std::size_t i = 0; i < kAhead; ++i) ahead = fetchNext(ahead);
  NowRunning now("act");
  for (const Element action : pending_) {
    ahead = fetchNext(ahead);
    const std::string_view head = action.head();
    if (head.empty()) continue;
    Slot* s = slot(head, *guess);
    if (s) guess = &s->next;
    if (Effector* e = s ? s->effector.get() : nullptr) {
      now.at(e);
      act(*e, action, log, cycle);
    } else if (hadRobot_ || head != kSync) {
      warn(log, cycle, fmt::format("no effector registered for predicate {}.", head));
    }
  }
  pending_.clear();
  pendingBytes_ = 0;
}

void Participant::act(Effector& effector, const Element& action, AgentLines& log, std::int64_t cycle) {
  try {
    if (const std::string why = effector.act(action); !why.empty()) warn(log, cycle, why);
  } catch (const std::exception& fault) {
    effector.kernel().countFault();
    warn(log, cycle, fmt::format("{} ({}) threw: {}", effector.path(), effector.classObject()->name(), fault.what()));
  } catch (...) {
    effector.kernel().countFault();
    warn(log, cycle, fmt::format("{} ({}) threw {}", effector.path(), effector.classObject()->name(), kNoException));
  }
}

void Participant::promote() {
  if (!inside_) return;
  if (pending_.empty()) std::swap(pending_, later_);
  for (const Element e : later_) pending_.append(e);
  later_.clear();
}

void Participant::share(std::uint64_t round) {
  if (shared_.empty()) return;
  NowRunning now("share");
  for (const Shared& s : shared_)
    if (isDue(*s.alive, nextCount())) now.at(s.alive), s.view->share(round);
}

void Participant::approachSensing(std::size_t distance) const {
  if (distance >= 3) return prefetch(this, sizeof *this);
  if (distance == 2) return prefetch(asked_.data(), asked_.size() * sizeof asked_[0]);
  for (std::size_t i = 0; i < std::min(asked_.size(), 2 * kAhead); ++i)
    prefetch(asked_[i], kPerceptor);  // sense fetches the others
}

bool Participant::sense(const Event& event) {
  prefetch(percepts_.tokens().data(), kBuffer);
  prefetch(message_.data(), kBuffer);
  for (std::size_t i = 0; i < std::min(asked_.size(), 2 * kAhead); ++i) prefetch(asked_[i]->parent(), kAbove);
  counter_ = nextCount();
  percepts_.clear();
  NowRunning now("sense");
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    Perceptor* p = asked_[i];
    if (i + kAhead < asked_.size()) prefetch(asked_[i + kAhead], kPart);
    if (!isDue(*p, counter_)) continue;
    const std::uint32_t before = percepts_.size();
    now.at(p);
    try {
      p->sense(percepts_, event);
    } catch (const std::exception& fault) {
      percepts_.truncate(before);
      faulty_ = i;
      fault_ = fault.what();
    } catch (...) {  // a thread's end is the host's
      percepts_.truncate(before);
      faulty_ = i;
      fault_ = kNoException;
    }
    if (percepts_.isUnbalanced()) [[unlikely]]
      balance(i);
  }
  encode();
  return faulty_ == kNone && unbalanced_ == kNone;
}

/// What comes behind an open list would be in it: other percepts are not to suffer.
void Participant::balance(std::size_t perceptor) {
  const int open = percepts_.balance();
  const std::uint64_t id = asked_[perceptor]->id();
  if (unbalanced_ != kNone || std::find(blamed_.begin(), blamed_.end(), id) != blamed_.end()) return;
  blamed_.push_back(id);
  unbalanced_ = perceptor;
  open_ = open;
}

void Participant::encode() {
  message_.clear();
  if (!percepts_.empty() && connection_ && parser()) parser()->write(percepts_, message_);
}

void Participant::save(StateWriter& out) const {
  out.write(counter_);
  out.write(Value(toList(percepts_)));
  if (!inside_) return;
  out.write(Value(toList(pending_)));
  out.write(Value(toList(later_)));
}

void Participant::load(StateReader& in) {
  const auto read = [&in](Predicates& to) {
    to.clear();
    append(in.readValue().toList(), to);
  };
  counter_ = in.readInteger();
  read(percepts_);
  encode();
  if (!inside_) return;
  read(pending_);
  read(later_);
}

void Participant::reportFaults(AgentLines& log) {
  if (const Perceptor* p = unbalanced_ != kNone ? perceptors_[unbalanced_].get() : nullptr)
    log.write(Level::error, fmt::format("{}: {} ({}) {} in sense(); its percept is as if it had closed what it opened. "
                                        "Each open() needs one close(). "
                                        "This is said once.",
                                        label_, p->path(), p->classObject()->name(),
                                        open_ > 0 ? fmt::format("left {} list(s) open", open_)
                                                  : std::string("closed a list that was not open")));
  unbalanced_ = kNone;
  if (faulty_ == kNone) return;
  if (const Perceptor* p = perceptors_[faulty_].get()) {
    p->kernel().countFault();
    log.write(Level::error, fmt::format("{}: {} ({}) threw and is asked no more: {}", label_, p->path(),
                                        p->classObject()->name(), fault_));
  }
  perceptors_.erase(perceptors_.begin() + static_cast<std::ptrdiff_t>(faulty_));
  asked_.erase(asked_.begin() + static_cast<std::ptrdiff_t>(faulty_));
  faulty_ = kNone;
}

bool Participant::deliver(AgentLines& log, std::int64_t cycle, Clock::time_point now) {
  if (percepts_.empty() || leaving()) return true;
  if (inside_) {
    const NowRunning now("think", behavior());
    try {
      behavior()->think(percepts_, later_);
    } catch (const std::exception& fault) {
      behavior()->kernel().countFault();
      warn(log, cycle, fmt::format("it threw: {}", fault.what()));
    }
    if (later_.isUnbalanced() && later_.balance() != 0)
      warn(log, cycle, "its actions did not close each list that they opened, once.");
    return true;
  }
  const bool first = sent_ == 0;
  if (!connection_->send(message_)) return false;
  ++sent_;
  if (askedAt_ == Clock::time_point()) askedAt_ = now;
  // What was held back answers the first percepts: it is realised with what comes next, before it.
  if (first && holdingBack_) {
    skipCycle_ = true;
    holdingBack_ = false;
    std::swap(pending_, later_);
    for (const Element e : later_) pending_.append(e);
    later_.clear();
  }
  return true;
}

void Participant::greet(const Predicates& percepts) {
  if (!connection_ || !parser()) return;
  message_.clear();
  parser()->write(percepts, message_);
  connection_->send(message_);
  message_.clear();
}

}  // namespace spark::gamecontrol
