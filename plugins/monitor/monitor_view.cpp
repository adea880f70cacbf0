#include "monitor_view.h"

#include <bit>
#include <utility>

#include "spark/random.h"

namespace spark {

namespace {
std::uint64_t mix(std::uint64_t h, std::uint64_t v) { return (h ^ v) * 0x9e3779b97f4a7c15ull + (h >> 29); }
}  // namespace

EntryKey keyOf(const Predicates& predicates, std::uint32_t token) {
  const auto& tokens = predicates.tokens();
  EntryKey key{hashBytes(Element(predicates, token).head()), 1};
  const std::uint32_t end = token + (tokens[token].kind == Token::Kind::list ? tokens[token].size : 1);
  for (std::uint32_t i = token; i < end; ++i) {
    const Token& t = tokens[i];
    key.content = mix(key.content, static_cast<std::uint64_t>(t.kind));
    switch (t.kind) {
      case Token::Kind::list:
        key.content = mix(key.content, t.size);
        break;
      case Token::Kind::text:
        key.content = mix(key.content, hashBytes(predicates.textOf(t)));
        break;
      case Token::Kind::number:
        key.content = mix(key.content, std::bit_cast<std::uint64_t>(t.number));
        break;
      case Token::Kind::integer:
        key.content = mix(key.content, static_cast<std::uint64_t>(t.integer));
        break;
    }
  }
  return key;
}

void MonitorView::addEvent(const Element& event) {
  if (update_.events.size() > kMaxEventTokens) dropOldEvents();
  const std::uint32_t at = update_.events.size();
  update_.events.append(event);
  eventsHash_ = mix(eventsHash_, keyOf(update_.events, at).content);
}

/// For viewers that never read: drops the older half of the waiting events.
void MonitorView::dropOldEvents() {
  const Predicates all = std::exchange(update_.events, {});
  eventsHash_ = 0;
  for (const Element event : all) {
    if (event.index() < all.size() / 2) continue;
    const std::uint32_t at = update_.events.size();
    update_.events.append(event);
    eventsHash_ = mix(eventsHash_, keyOf(update_.events, at).content);
  }
}

void MonitorView::encode(IMonitorEncoder& encoder, std::string& out) {
  update_.full = willBeFull();
  pickNodes();
  pickEntries();
  shape_ = newest_.frame.shape;
  needsFull_ = false;
  historyHash_ = mix(update_.full ? newestId_ : historyHash_, newest_.serial);
  encoder.encode(update_, out);
}

void MonitorView::pickNodes() {
  const auto& nodes = newest_.frame.nodes;
  if (update_.full) {
    matrices_.resize(nodes.size());
    visible_.resize(nodes.size());
  }
  update_.changed.assign(nodes.size(), 0);
  std::uint64_t newest = newestId_;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    bool differs = false;
    if (nodes[i].kind == FrameNode::Kind::transform) {
      // A full update has nothing to compare with: matrices_[i] may be uninitialized.
      differs = update_.full || !((nodes[i].local - matrices_[i]).cwiseAbs().maxCoeff() <= newest_.precision);
      if (differs) matrices_[i] = nodes[i].local;
    } else {
      // As SimSpark, the first diff after a mesh was created repeats its visibility.
      differs =
          nodes[i].kind != FrameNode::Kind::light && (newest_.ids[i] > newestId_ || visible_[i] != nodes[i].visible);
      visible_[i] = nodes[i].visible;
      newest = std::max(newest, newest_.ids[i]);
    }
    update_.changed[i] = differs && !update_.full;
  }
  if (!update_.full) newestId_ = newest;
}

void MonitorView::pickEntries() {
  const auto& entries = newest_.frame.env.entries;
  update_.env.clear();
  if (update_.full) entries_.clear();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bool wanted = update_.full;
    switch (entries[i].policy) {
      case EnvPolicy::full:
        break;
      case EnvPolicy::change:
        wanted |= changed(newest_.keys[i]);
        break;
      case EnvPolicy::always:
        wanted = true;
        break;
      case EnvPolicy::once:
        wanted = false;
        break;  // sent as an event
    }
    if (wanted) update_.env.push_back(entries[i].token);
  }
}

bool MonitorView::changed(const EntryKey& key) {
  for (EntryKey& sent : entries_)
    if (sent.name == key.name) return std::exchange(sent.content, key.content) != key.content;
  entries_.push_back(key);
  return true;
}

void MonitorView::delivered() {
  update_.events.clear();
  eventsHash_ = 0;
}

bool MonitorView::isEquivalent(const MonitorView& other) const {
  const bool full = willBeFull();
  return full == other.willBeFull() && eventsHash_ == other.eventsHash_ && newestId_ == other.newestId_ &&
         (full || historyHash_ == other.historyHash_);
}

void MonitorView::copyState(const MonitorView& other) {
  matrices_ = other.matrices_;
  visible_ = other.visible_;
  entries_ = other.entries_;
  shape_ = other.shape_;
  newestId_ = other.newestId_;
  historyHash_ = other.historyHash_;
  needsFull_ = other.needsFull_;
  update_.full = other.update_.full;
}

}  // namespace spark
