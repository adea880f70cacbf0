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
  if (update_.events.size() > kMostWaiting) forgetOldEvents();
  const std::uint32_t at = update_.events.size();
  update_.events.append(event);
  events_ = mix(events_, keyOf(update_.events, at).content);
}

/// For viewers that never read.
void MonitorView::forgetOldEvents() {
  const Predicates all = std::exchange(update_.events, {});
  events_ = 0;
  for (const Element event : all) {
    if (event.index() < all.size() / 2) continue;
    const std::uint32_t at = update_.events.size();
    update_.events.append(event);
    events_ = mix(events_, keyOf(update_.events, at).content);
  }
}

void MonitorView::encode(IMonitorEncoder& encoder, std::string& out) {
  update_.full = willBeFull();
  pickNodes();
  pickEntries();
  shape_ = newest_.frame.shape;
  needsFull_ = false;
  history_ = mix(update_.full ? newestId_ : history_, newest_.serial);
  encoder.encode(update_, out);
}

void MonitorView::pickNodes() {
  const auto& nodes = newest_.frame.nodes;
  if (update_.full) {
    sent_.resize(nodes.size());
    visible_.resize(nodes.size());
  }
  update_.changed.assign(nodes.size(), 0);
  std::uint64_t newest = newestId_;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    bool differs = false;
    if (nodes[i].kind == FrameNode::Kind::transform) {
      // With a full update there is nothing to compare with: what was sent is new memory.
      differs = update_.full || !((nodes[i].local - sent_[i]).cwiseAbs().maxCoeff() <= newest_.precision);
      if (differs) sent_[i] = nodes[i].local;
    } else {
      // The first diff after a mesh came repeats its visibility: the installed base's monitors have always been sent
      // that.
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
  if (update_.full) told_.clear();
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
        break;  // waits among the events
    }
    if (wanted) update_.env.push_back(entries[i].token);
  }
}

bool MonitorView::changed(const EntryKey& key) {
  for (EntryKey& told : told_) {
    if (told.name != key.name) continue;
    const bool differs = told.content != key.content;
    told.content = key.content;
    return differs;
  }
  told_.push_back(key);
  return true;
}

void MonitorView::delivered() {
  update_.events.clear();
  events_ = 0;
}

bool MonitorView::isLike(const MonitorView& other) const {
  const bool full = willBeFull();
  return full == other.willBeFull() && events_ == other.events_ && newestId_ == other.newestId_ &&
         (full || history_ == other.history_);
}

void MonitorView::become(const MonitorView& other) {
  sent_ = other.sent_;
  visible_ = other.visible_;
  told_ = other.told_;
  shape_ = other.shape_;
  newestId_ = other.newestId_;
  history_ = other.history_;
  needsFull_ = other.needsFull_;
  update_.full = other.update_.full;
}

}  // namespace spark
