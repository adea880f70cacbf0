#include "agent_mind.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace spark::spades {

namespace {
constexpr std::size_t kMostRequests = 64;  // per cycle; agents of the time send 20

std::optional<Time> timeIn(std::string_view text) {
  Time t = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), t);
  if (error != std::errc() || end == text.data()) return std::nullopt;
  return t;
}
}  // namespace

void AgentMind::sense(Time sent, std::string data) {
  pending_.push_back({sent + latencies_.sense, sent, std::move(data)});
}

/// The earliest message; among equals the one that was queued first.
std::deque<AgentMind::Pending>::iterator AgentMind::firstDue() {
  return std::min_element(pending_.begin(), pending_.end(),
                          [](const Pending& a, const Pending& b) { return a.due < b.due; });
}

std::optional<std::string> AgentMind::next(Time now, Time least) {
  if (!ready_ || thinking_) return std::nullopt;
  for (auto first = firstDue(); first != pending_.end(); first = firstDue()) {
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
    least_ = least;
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
      return thinking_ ? Result::done : Result::nothing;  // some answer D to K
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

}  // namespace spark::spades
