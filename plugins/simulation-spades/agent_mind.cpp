#include "agent_mind.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "spark/assert.h"

namespace spark::spades {

namespace {
constexpr std::size_t kMostRequests = 64;  // per cycle; agents of the time send 20

std::optional<Time> timeIn(std::string_view text) {
  Time t = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), t);
  if (error != std::errc() || end == text.data()) return std::nullopt;
  return t;
}

/// The earliest message; among equals the one that was queued first.
auto firstDue(auto& pending) {
  return std::min_element(pending.begin(), pending.end(), [](const auto& a, const auto& b) { return a.due < b.due; });
}
}  // namespace

void AgentMind::sense(Time sent, std::string data) {
  pending_.push_back({sent + latencies_.sense, sent, std::move(data)});
}

std::optional<std::string> AgentMind::next(Time now, Time least) {
  if (!ready_ || thinking_) return std::nullopt;
  least_ = least;
  if (informed_) return std::nullopt;
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
    return p.sent < 0 ? fmt::format("T{}", p.due) : fmt::format("S{} {} {}", p.sent, at, p.data);
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
      if (thinking_ && !text.empty()) acts_.emplace_back(text);
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
  if (std::exchange(stale_, false)) {
    acts_.clear();
    requests_.clear();
    return;
  }
  ended_ = began_ + std::max(thought, least_);
  thoughts_.add(ended_ - began_);
  for (std::string& data : acts_) acts.push_back({ended_ + latencies_.act, std::move(data)});
  acts_.clear();
  for (const Time t : requests_) pending_.push_back({t, -1, {}});
  requests_.clear();
}

void AgentMind::forget() {
  pending_.clear();
  ended_ = 0;
  stale_ = thinking_;
}

std::string AgentMind::inform() {
  SPARK_ASSERT(!thinking_);
  informed_ = true;
  return fmt::format("K{}", ended_ - began_);
}

Time AgentMind::horizon() const {
  if (thinking_) return stale_ ? 0 : began_ + least_ + latencies_.act;
  // What is pending begins a cycle at the time at which it is due, even if the agent answers later.
  if (!informed_ || pending_.empty()) return kNever;
  return std::max(firstDue(pending_)->due, ended_) + least_ + latencies_.act;
}

}  // namespace spark::spades
