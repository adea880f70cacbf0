#include "delay_line.h"

#include <fmt/format.h>

#include <utility>

#include "spark/error.h"

namespace spark::modifiers {

namespace {
constexpr double kTolerance = 1e-6;  // s; times are sums of steps

std::size_t bytesOf(const Signal& signal) {
  std::size_t bytes = 0;
  for (std::uint32_t i = (*signal.begin()).index(), end = i + signal.size(); i < end; ++i)
    bytes += sizeof(Token) + signal.at(i).text().size();
  return bytes;
}
}  // namespace

void DelayLine::pass(Signal& signal, double time, std::int64_t cycles, double seconds) {
  take(signal, {cycle_ + cycles, time + seconds, 0, 0});
  release(signal, time);
  dropReleased();
  ++cycle_;
}

void DelayLine::take(Signal& signal, const Entry& due) {
  if (signal.empty()) return;
  Entry entry = due;
  entry.bytes = bytesOf(signal);
  if (bytes_ + entry.bytes <= kMaxBytes) {
    for (const Element list : signal) lists_.append(list), ++entry.elements;
    bytes_ += entry.bytes;
    entries_.push_back(entry);
  }
  signal.clear();
}

void DelayLine::release(Signal& signal, double time) {
  for (; left_ < entries_.size(); ++left_) {
    const Entry& entry = entries_[left_];
    if (entry.cycle > cycle_ || entry.time > time + kTolerance) return;
    Element::Iterator list(lists_, leftTokens_);
    for (std::uint32_t i = 0; i < entry.elements; ++i, ++list) signal.append(*list);
    leftTokens_ = (*list).index();
    bytes_ -= entry.bytes;
  }
}

/// Copies the others when at least half of the lists have left, so that each is copied once on average.
void DelayLine::dropReleased() {
  if (leftTokens_ == 0 || 2 * leftTokens_ < lists_.size()) return;
  spare_.clear();
  for (Element::Iterator list(lists_, leftTokens_); list != lists_.end(); ++list) spare_.append(*list);
  std::swap(lists_, spare_);
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(left_));
  left_ = leftTokens_ = 0;
}

void DelayLine::save(StateWriter& out) const {
  Predicates waiting;
  for (Element::Iterator list(lists_, leftTokens_); list != lists_.end(); ++list) waiting.append(*list);
  out.write(cycle_);
  out.write(entries_.size() - left_);
  for (std::size_t i = left_; i < entries_.size(); ++i) {
    out.write(entries_[i].cycle);
    out.write(entries_[i].time);
    out.write(std::uint64_t(entries_[i].elements));
    out.write(std::uint64_t(entries_[i].bytes));
  }
  savePredicates(waiting, out);
}

void DelayLine::load(StateReader& in) {
  *this = {};
  cycle_ = in.readInteger();
  std::int64_t elements = 0;
  for (std::int64_t n = in.readInteger(); n > 0; --n) {
    Entry& e = entries_.emplace_back();
    e.cycle = in.readInteger();
    e.time = in.readNumber();
    e.elements = static_cast<std::uint32_t>(in.readInteger());
    e.bytes = static_cast<std::size_t>(in.readInteger());
    bytes_ += e.bytes;
    elements += e.elements;
  }
  const List waiting = in.readValue().toList();
  if (static_cast<std::int64_t>(waiting.size()) != elements)
    throw Error(fmt::format("expected the {} lists of a delay, found {}", elements, waiting.size()));
  append(waiting, lists_);
}

}  // namespace spark::modifiers
