#include "monitor_client.h"

#include <bit>

#include "spark/random.h"

namespace spark {

EntryKey keyOf(const Predicates& predicates, std::uint32_t token) {
  const auto mix = [](std::uint64_t h, std::uint64_t v) { return (h ^ v) * 0x9e3779b97f4a7c15ull + (h >> 29); };
  const auto& tokens = predicates.tokens();
  EntryKey key{hashBytes(Element(predicates, token).head()), 1};
  for (std::uint32_t i = token; i < tokens[token].end; ++i) {
    const Token& t = tokens[i];
    key.content = mix(key.content, static_cast<std::uint64_t>(t.kind));
    switch (t.kind) {
      case Token::Kind::list: key.content = mix(key.content, t.end - i); break;
      case Token::Kind::text: key.content = mix(key.content, hashBytes(predicates.textOf(t))); break;
      case Token::Kind::number: key.content = mix(key.content, std::bit_cast<std::uint64_t>(t.number)); break;
      case Token::Kind::integer: key.content = mix(key.content, static_cast<std::uint64_t>(t.integer)); break;
    }
  }
  return key;
}

void MonitorClient::encode(IMonitorEncoder& encoder, const std::vector<std::uint64_t>& ids, const std::vector<EntryKey>& keys, float precision) {
  update_.full = needsFull_ || shape_ != update_.frame.shape;
  pickNodes(ids, precision);
  pickEntries(keys);
  shape_ = update_.frame.shape;
  needsFull_ = false;
  message_.clear();
  encoder.encode(update_, message_);
}

void MonitorClient::pickNodes(const std::vector<std::uint64_t>& ids, float precision) {
  const auto& nodes = update_.frame.nodes;
  if (update_.full) {
    sent_.resize(nodes.size());
    visible_.resize(nodes.size());
  }
  update_.changed.assign(nodes.size(), 0);
  std::uint64_t newest = newestId_;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    bool differs = false;
    if (nodes[i].kind == FrameNode::Kind::transform) {
      differs = !((nodes[i].local - sent_[i]).cwiseAbs().maxCoeff() <= precision);
      if (differs || update_.full) sent_[i] = nodes[i].local;
    } else {
      // The first diff after a mesh came repeats its visibility: the installed base's monitors have always been sent that.
      differs = nodes[i].kind != FrameNode::Kind::light && (ids[i] > newestId_ || visible_[i] != nodes[i].visible);
      visible_[i] = nodes[i].visible;
      newest = std::max(newest, ids[i]);
    }
    update_.changed[i] = differs && !update_.full;
  }
  if (!update_.full) newestId_ = newest;
}

void MonitorClient::pickEntries(const std::vector<EntryKey>& keys) {
  const auto& entries = update_.frame.env.entries;
  update_.env.clear();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bool wanted = update_.full;
    switch (entries[i].policy) {
      case EnvPolicy::full: break;
      case EnvPolicy::change: wanted |= changed(keys[i]); break;
      case EnvPolicy::always: wanted = true; break;
      case EnvPolicy::once: wanted = false; break;  // waits among the events
    }
    if (wanted) update_.env.push_back(entries[i].token);
  }
}

bool MonitorClient::changed(const EntryKey& key) {
  for (EntryKey& told : told_) {
    if (told.name != key.name) continue;
    const bool differs = told.content != key.content;
    told.content = key.content;
    return differs;
  }
  told_.push_back(key);
  return true;
}

void MonitorClient::send() {
  if (connection_.send(message_))
    update_.events.clear();
  else
    requestFull();  // it was not taken: nothing is known of what the client has
}

void MonitorClient::close(std::string_view reason) {
  if (closing_) return;
  closing_ = true;
  connection_.close(reason);
}

}  // namespace spark
