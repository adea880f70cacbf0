#include "agent_mind.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "spark/assert.h"

namespace spark::spades {

namespace {
constexpr std::size_t kMostRequests = 64;    // per cycle; agents of the time send 20
constexpr std::ptrdiff_t kMostAhead = 1024;  // requests of an agent that wait for their time
constexpr Time kMostTime = kNever / 2;       // of a request, so that latencies can be added

std::optional<Time> timeIn(std::string_view text) {
  Time t = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), t);
  if (error != std::errc() || end == text.data() || t > kMostTime) return std::nullopt;
  return t;
}

/// The earliest message; among equals the one that was queued first.
auto firstDue(auto& pending) {
  return std::min_element(pending.begin(), pending.end(), [](const auto& a, const auto& b) { return a.due < b.due; });
}
}  // namespace

void AgentMind::sense(Time sent, std::string data) {
  arrival_ = std::max(arrival_, sent + latencies_.sense);
  pending_.push_back({arrival_, sent, std::move(data)});
}

const AgentMind::Terms& AgentMind::termsAt(Time at) const {
  const auto later = std::find_if(terms_.begin() + 1, terms_.end(), [at](const Terms& t) { return t.from > at; });
  return *(later - 1);
}

std::optional<std::string> AgentMind::next(Time now, const ThinkModel& model) {
  if (terms_.empty() || terms_.back().act != latencies_.act || terms_.back().model != model)
    terms_.push_back({now, latencies_.act, model});
  if (!ready_ || thinking_ || informed_) return std::nullopt;
  for (auto first = firstDue(pending_); first != pending_.end(); first = firstDue(pending_)) {
    const Time at = std::max(first->due, ended_);
    if (at > now) return std::nullopt;
    const Pending p = std::move(*first);
    pending_.erase(first);
    if (p.sent >= 0 && at - p.due > latencies_.mostWaiting) {
      ++dropped_;
      continue;
    }
    thinking_ = true;
    began_ = at;
    cycle_ = termsAt(at);
    std::erase_if(terms_, [this](const Terms& t) { return t.from < cycle_.from; });
    return p.sent < 0 ? "T" + p.data : fmt::format("S{} {} {}", p.sent, at, p.data);
  }
  return std::nullopt;
}

AgentMind::Result AgentMind::take(std::string_view message) {
  if (message.empty()) return Result::nothing;
  const std::string_view text = message.substr(1);
  switch (message.front()) {
    case 'I':
      return std::exchange(ready_, true) ? Result::nothing : Result::ready;
    case 'A':
      if (!thinking_ || text.empty()) return Result::nothing;
      actBytes_ += text.size() + sizeof(std::string);
      if (actBytes_ > kMostActs) return Result::flood;
      acts_.emplace_back(text);
      return Result::nothing;
    case 'R':
      if (const auto t = timeIn(text); t && thinking_ && requests_.size() < kMostRequests) requests_.push_back(*t);
      return Result::nothing;
    case 'C':
      return thinking_ ? Result::question : Result::nothing;
    case 'D':
      if (thinking_) return Result::done;
      informed_ = false;
      return Result::nothing;
    case 'X':
      return Result::exit;
    default:
      return Result::nothing;
  }
}

void AgentMind::end(Time thought, std::vector<Act>& acts) {
  thinking_ = false;
  actBytes_ = 0;
  if (std::exchange(stale_, false)) {
    acts_.clear();
    requests_.clear();
    return;
  }
  ended_ = began_ + std::max(thought, cycle_.model.least());
  thoughts_.add(ended_ - began_);
  effect_ = std::max(effect_, ended_ + cycle_.act);
  for (std::string& data : acts_) acts.push_back({effect_, std::move(data)});
  acts_.clear();
  auto ahead = std::count_if(pending_.begin(), pending_.end(), [](const Pending& p) { return p.sent < 0; });
  // After a cycle that took no time the next one that was requested begins later, or time would never go on.
  const Time earliest = ended_ > began_ ? std::numeric_limits<Time>::min() : began_ + 1;
  for (const Time t : requests_)
    if (ahead++ < kMostAhead) pending_.push_back({std::max(t, earliest), -1, std::to_string(t)});
  requests_.clear();
}

void AgentMind::forget() {
  pending_.clear();
  ended_ = arrival_ = effect_ = 0;
  if (!terms_.empty()) terms_ = {{0, terms_.back().act, terms_.back().model}};
  stale_ = thinking_;
}

std::string AgentMind::inform() {
  SPARK_ASSERT(!thinking_);
  informed_ = true;
  return fmt::format("K{}", ended_ - began_);
}

Time AgentMind::horizon() const {
  if (thinking_) return stale_ ? 0 : std::max(effect_, cycle_.effect(began_));
  // What is pending begins a cycle at the time at which it is due, even if the agent answers later.
  if (!informed_ || pending_.empty()) return kNever;
  const Time at = std::max(firstDue(pending_)->due, ended_);
  return std::max(effect_, termsAt(at).effect(at));
}

}  // namespace spark::spades
