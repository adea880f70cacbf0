#include "recorded_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spark {

namespace {

// Limits that no monitor server reaches; what exceeds them is dropped.
constexpr std::size_t kMaxTextBytes = 512, kMaxMaterials = 64, kMaxEntries = 256;

/// Depth and tokens of a message; one of 22 robots has about 15,000 tokens.
constexpr ReadLimits kLimits{64, 1u << 18};

/// True if the text can be sent as an atom without quotes.
bool isPlain(std::string_view text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](unsigned char c) {
    return c <= ' ' || c == 127 || c == '(' || c == ')' || c == '"' || c == '\'' || c == ';' || c == '\\';
  });
}

/// The atoms after a list's head, separated by blanks.
std::string argumentsOf(const Element& list) {
  std::string out;
  bool head = true;
  for (const Element e : list) {
    if (std::exchange(head, false)) continue;
    const std::string number = e.isText() || e.isList()
                                   ? std::string()
                                   : fmt::format("{:g}", e.number());  // in JSON a mesh's parameters are numbers
    const std::string_view word = number.empty() ? e.text() : number;
    if (out.size() + word.size() < kMaxTextBytes) out.append(out.empty() ? "" : " ").append(word);
  }
  return out;
}

/// Reads up to `count` numbers after a list's head. An element of `out` stays as it is if its number is missing or not
/// finite.
void readNumbers(const Element& list, float* out, int count) {
  int i = -1;
  for (const Element e : list) {
    if (const auto v = static_cast<float>(e.number()); i >= 0 && i < count && std::isfinite(v)) out[i] = v;
    ++i;
  }
}

Color readColor(const Element& list) {
  float v[4] = {0, 0, 0, 1};
  readNumbers(list, v, 4);
  return {v[0], v[1], v[2], v[3]};
}

bool isNode(const Element& e) { return e.isList() && e.head() == "nd"; }

bool sameColor(const Color& a, const Color& b) { return a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a; }

}  // namespace

bool RecordedScene::Visual::looksLike(const Visual& o) const {
  return what == o.what && mesh == o.mesh && size == o.size && glass == o.glass && names == o.names &&
         std::equal(colors.begin(), colors.end(), o.colors.begin(), sameColor);
}

void RecordedScene::clear() {
  nodes_.clear();
  visuals_.clear();
  ids_.clear();
  entries_.clear();
  events_.clear();
  known_ = false;
  ++shape_;
}

std::string RecordedScene::take(std::string_view message, IParser* parser) {
  parsed_.clear();
  const bool json = message.starts_with('[');
  if (json && !parser)
    return "it is JSON: expected a parser below the player, e.g. new(\"JsonParser\", "
           "\"/sys/server/monitor/player/parser\")";
  // Parse and check the form: environment, header, nodes.
  const ReadResult result = json ? parser->parse(message, parsed_) : readSexp(message, parsed_, kLimits);
  if (!result.message.empty()) return result.message;
  for (const Token& t : parsed_.tokens())
    if (t.kind == Token::Kind::text && !isPlain(parsed_.textOf(t)))
      return "expected plain words and numbers, found quoted text";
  Element parts[3];
  std::size_t count = 0;
  for (const Element e : parsed_) {
    if (count < 3) parts[count] = e;
    ++count;
  }
  if (count != 3 || !parts[0].isList() || !parts[2].isList()) return "expected three lists";
  const bool full = parts[1].head() == "RSG";
  if (!full && parts[1].head() != "RDS") return "expected (RSG 0 1) or (RDS 0 1)";

  // Replace or patch the nodes; the environment comes last, since the message may still be refused here.
  if (full) {
    newNodes_.clear();
    newVisuals_.clear();
    if (std::string wrong = readNodes(parts[2], 0); !wrong.empty()) return wrong;
    if (!known_ || !sameShape(newNodes_, newVisuals_)) {
      ++shape_;
      ids_.resize(newNodes_.size());
      for (std::uint64_t& id : ids_) id = ++lastId_;
    }
    std::swap(nodes_, newNodes_);
    std::swap(visuals_, newVisuals_);
    known_ = true;
  } else {
    if (!known_) return "expected a full message first, found a diff";
    std::size_t next = 0;
    if (std::string wrong = checkDiff(parts[2], 0, next); !wrong.empty()) return wrong;
    if (next != nodes_.size()) return "expected the nodes of the last full message, found fewer";
    next = 0;
    patch(parts[2], next);
  }
  readEnvironment(parts[0], full);
  return {};
}

std::string RecordedScene::readNodes(const Element& list, int depth) {
  for (const Element e : list)
    if (isNode(e))
      if (std::string wrong = readNode(e, depth); !wrong.empty()) return wrong;
  return {};
}

std::string RecordedScene::readNode(const Element& element, int depth) {
  const Element type = element.at(1);
  const std::string_view name = type ? type.text() : std::string_view();
  FrameNode node;
  node.depth = depth;
  std::unique_ptr<Visual> visual;
  if (name != "TRF") {
    visual = std::make_unique<Visual>(owner_);
    if (name == "Light")
      visual->what = IVisual::Kind::light, node.kind = FrameNode::Kind::light;
    else if (name == "StaticMesh")
      visual->what = IVisual::Kind::mesh, node.kind = FrameNode::Kind::mesh;
    else if (name == "SMN")
      visual->what = IVisual::Kind::singleMaterial, node.kind = FrameNode::Kind::singleMaterial;
    else
      return fmt::format("expected a node of type TRF, Light, StaticMesh or SMN, found '{}'", name.substr(0, 40));
  }
  for (const Element e : element) {
    if (!e.isList()) continue;
    const std::string_view head = e.head();
    if (!visual) {
      if (head == "SLT") readNumbers(e, node.local.data(), 16);
      continue;
    }
    if (head == "setVisible") visual->shown = e.at(1) && e.at(1).number() == 1;
    if (head == "setTransparent") visual->glass = true;
    if (head == "load") visual->mesh = argumentsOf(e);
    if (head == "sSc") readNumbers(e, visual->size.data(), 3);
    if (head == "sMat" && e.at(1)) visual->names = {std::string(e.at(1).text())};
    if (head == "setDiffuse") visual->colors[0] = readColor(e);
    if (head == "setAmbient") visual->colors[1] = readColor(e);
    if (head == "setSpecular") visual->colors[2] = readColor(e);
    if (head != "resetMaterials") continue;
    visual->names.clear();
    bool first = true;
    for (const Element name : e) {
      if (!std::exchange(first, false) && visual->names.size() < kMaxMaterials)
        visual->names.emplace_back(name.text().substr(0, kMaxTextBytes));
    }
  }
  if (visual && node.kind != FrameNode::Kind::light && visual->mesh.empty())
    return "expected a mesh's name (load ...), found none";
  newNodes_.push_back(node);
  newVisuals_.push_back(std::move(visual));
  return readNodes(element, depth + 1);
}

/// Checks that a diff has the nodes of the last full message. `next`: index of the next node.
std::string RecordedScene::checkDiff(const Element& list, int depth, std::size_t& next) const {
  for (const Element e : list) {
    if (!isNode(e)) continue;
    if (next >= nodes_.size() || nodes_[next].depth != depth)
      return "expected the nodes of the last full message, found others";
    ++next;
    if (std::string wrong = checkDiff(e, depth + 1, next); !wrong.empty()) return wrong;
  }
  return {};
}

void RecordedScene::patch(const Element& list, std::size_t& next) {
  for (const Element e : list) {
    if (!isNode(e)) continue;
    FrameNode& node = nodes_[next];
    Visual* visual = visuals_[next].get();
    ++next;
    for (const Element item : e) {
      if (!item.isList()) continue;
      if (!visual && item.head() == "SLT") readNumbers(item, node.local.data(), 16);
      if (visual && item.head() == "setVisible") visual->shown = item.at(1) && item.at(1).number() == 1;
    }
    patch(e, next);
  }
}

void RecordedScene::readEnvironment(const Element& list, bool full) {
  events_.clear();
  if (full) entries_.clear();
  for (Entry& entry : entries_) entry.current = false;
  for (const Element e : list) {
    if (e.head().empty()) continue;
    if (e.head() == "foul" || e.head() == "messages") {
      events_.append(e);
      continue;
    }
    auto at =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& known) { return known.name == e.head(); });
    if (at == entries_.end() && entries_.size() >= kMaxEntries) continue;
    if (at == entries_.end()) at = entries_.insert(at, Entry{std::string(e.head()), {}, false});
    at->value.clear();
    at->value.append(e);
    at->current = true;
  }
}

std::shared_ptr<const RecordedScene::Snapshot> RecordedScene::snapshot() const {
  auto out = std::make_shared<Snapshot>();
  out->nodes.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::copy_n(nodes_[i].local.data(), 16, out->nodes[i].first.begin());
    out->nodes[i].second = visuals_[i] && visuals_[i]->shown;
  }
  out->entries = entries_;
  out->events = events_;
  return out;
}

bool RecordedScene::restore(const Snapshot& snapshot) {
  if (snapshot.nodes.size() != nodes_.size()) return false;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::copy_n(snapshot.nodes[i].first.begin(), 16, nodes_[i].local.data());
    if (visuals_[i]) visuals_[i]->shown = snapshot.nodes[i].second;
  }
  entries_ = snapshot.entries;
  events_ = snapshot.events;
  return true;
}

bool RecordedScene::sameShape(const std::vector<FrameNode>& nodes, const Visuals& visuals) const {
  if (nodes.size() != nodes_.size()) return false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].kind != nodes_[i].kind || nodes[i].depth != nodes_[i].depth) return false;
    if (visuals[i] && !visuals[i]->looksLike(*visuals_[i])) return false;
  }
  return true;
}

void RecordedScene::copyTo(MonitorFrame& frame, std::vector<std::uint64_t>& ids, bool events) const {
  frame.nodes.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    FrameNode& node = frame.nodes[i] = nodes_[i];
    node.visual = visuals_[i].get();
    if (!node.visual) continue;
    node.visible = node.visual->visible();
    node.transparent = node.visual->transparent();
  }
  ids = ids_;
  Environment& env = frame.env;
  const auto add = [&env](EnvPolicy policy, const Element& e) {
    env.entries.push_back({policy, env.predicates.size()});
    env.predicates.append(e);
  };
  for (const Entry& entry : entries_) {
    // Pass mode entries are in the messages only while the wait lasts.
    const bool temporary = entry.name.starts_with("pass_mode_score_wait");
    if (temporary && !entry.current) continue;
    add(temporary || entry.name == "time" ? EnvPolicy::always : EnvPolicy::change, *entry.value.begin());
  }
  if (events)
    for (const Element e : events_) add(EnvPolicy::once, e);
}

}  // namespace spark
