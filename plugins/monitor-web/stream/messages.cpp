#include "messages.h"

#include <array>
#include <charconv>
#include <utility>

#include "spark/abi.h"

namespace spark::web {

namespace {

/// Significant digits of a number in an entry, such as the game time.
constexpr int kEntryDigits = 10;

void writeShape(JsonWriter& json, const SceneShape& shape) {
  constexpr const char* kNames[] = {"box", "sphere", "capsule", "cylinder"};
  json.beginObject().member("kind", kNames[static_cast<int>(shape.kind)]);
  json.key("size").numbers(shape.size);
  json.key("position").numbers(std::array{shape.position.x(), shape.position.y(), shape.position.z()});
  json.key("rotation").numbers(shape.rotation).endObject();
}

void writeTransform(JsonWriter& json, const NodeDescription& node, const Mount& mount) {
  json.member("kind", "transform");
  if (mount.on >= 0) json.member("on", mount.on).key("pin").numbers(mount.pin);
  if (!node.path.empty()) json.member("path", node.path);
  if (node.shapes.empty()) return;
  json.key("shapes").beginArray();
  for (const SceneShape& shape : node.shapes) writeShape(json, shape);
  json.endArray();
}

void writeColor(JsonWriter& json, const Color& c) { json.numbers(std::array{c.r, c.g, c.b, c.a}); }

/// The path of a resource, as member `name` if there is one.
void writeLink(JsonWriter& json, const char* name, AssetKind kind, const std::string& resource, const AssetLink& link) {
  if (!link || resource.empty()) return;
  if (const std::string path = link(kind, resource); !path.empty()) json.member(name, path);
}

void writeMesh(JsonWriter& json, const NodeDescription& node, bool visible, const AssetLink& link) {
  json.member("kind", "mesh");
  if (node.kind == FrameNode::Kind::singleMaterial) json.member("single", true);
  json.member("load", node.load);
  writeLink(json, "file", AssetKind::mesh, node.load, link);
  json.key("scale").numbers(std::array{node.scale.x(), node.scale.y(), node.scale.z()});
  if (!node.materials.empty()) {
    json.key("materials").beginArray();
    for (const std::string& name : node.materials) json.value(name);
    json.endArray();
  }
  if (node.transparent) json.member("transparent", true);
  json.member("visible", visible);
}

/// `mount`: of a transform.
void writeNode(JsonWriter& json, const NodeDescription& node, bool visible, const Mount& mount, const AssetLink& link) {
  json.beginObject().member("parent", node.parent);
  switch (node.kind) {
    case FrameNode::Kind::transform:
      writeTransform(json, node, mount);
      break;
    case FrameNode::Kind::light:
      json.member("kind", "light").key("colors").beginArray();
      for (const Color& c : node.colors) writeColor(json, c);
      json.endArray();
      break;
    case FrameNode::Kind::mesh:
    case FrameNode::Kind::singleMaterial:
      writeMesh(json, node, visible, link);
      break;
  }
  json.endObject();
}

/// True if the text is a number. In recorded games all atoms are texts.
bool isNumber(std::string_view text) {
  if (text.find_first_not_of("0123456789+-.eE") != text.npos) return false;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// The environment message with the entries at `tokens`.
std::string environmentMessage(const Snapshot& s, bool full, const std::vector<std::uint32_t>& tokens) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", "environment").key("time").value(s.time, kEntryDigits);
  if (full) json.member("full", true);
  json.key("entries").beginArray();
  for (const std::uint32_t token : tokens) writeElement(json, Element(s.environment.predicates, token));
  json.endArray().endObject();
  return out;
}

std::string jsonOf(const Element& element) {
  std::string out;
  JsonWriter json(out, kWebJson);
  writeElement(json, element);
  return out;
}

}  // namespace

void writeElement(JsonWriter& json, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text:
      if (isNumber(element.text()))
        json.value(element.number(), kEntryDigits);
      else
        json.value(element.text());
      return;
    case Token::Kind::number:
      json.value(token.number, kEntryDigits);
      return;
    case Token::Kind::integer:
      json.value(token.integer);
      return;
    case Token::Kind::list:
      break;
  }
  json.beginArray();
  for (const Element inner : element) writeElement(json, inner);
  json.endArray();
}

std::string helloMessage(double step, double rate, double history) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", "hello").member("protocol", 2).member("spark", SPARK_VERSION);
  json.member("step", step).member("rate", rate).member("history", history).endObject();
  return out;
}

void writeLook(JsonWriter& json, const IMaterial::Look& look, const std::string& texture, const AssetLink& link) {
  writeColor(json.key("diffuse"), look.diffuse);
  writeColor(json.key("ambient"), look.ambient);
  writeColor(json.key("specular"), look.specular);
  writeColor(json.key("emission"), look.emission);
  json.member("shininess", look.shininess);
  if (!texture.empty()) json.member("texture", texture);
  writeLink(json, "picture", AssetKind::texture, texture, link);
}

std::string sceneMessage(const Snapshot& s, std::uint32_t shape, const AssetLink& link) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", "scene").member("shape", shape).key("nodes").beginArray();
  const auto& nodes = s.scene->nodes;
  const auto& mounts = s.scene->mounts;
  std::size_t transform = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool mounted = nodes[i].kind == FrameNode::Kind::transform && transform < mounts.size();
    writeNode(json, nodes[i], s.visible[i], mounted ? mounts[transform++] : Mount{}, link);
  }
  json.endArray().key("materials").beginArray();
  for (const MaterialDescription& m : s.scene->materials) {
    json.beginObject().member("name", m.name);
    writeLook(json, m.look, m.texture, link);
    json.endObject();
  }
  json.endArray().key("local").beginArray();
  for (const Matrix& m : s.transforms)
    for (int k = 0; k < 16; ++k) json.value(m.data()[k]);
  json.endArray().endObject();
  return out;
}

std::string fullEnvironmentMessage(const Snapshot& s) {
  std::vector<std::uint32_t> tokens;
  for (const Environment::Entry& entry : s.environment.entries)
    if (entry.policy != EnvPolicy::once) tokens.push_back(entry.token);
  return environmentMessage(s, true, tokens);
}

std::string eventMessage(double time, const Element& event) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", "event").key("time").value(time, kEntryDigits).key("entry");
  writeElement(json, event);
  json.endObject();
  return out;
}

std::string reply(std::string_view type, std::int64_t id, std::string_view answer) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", type).member("id", id).members(answer).endObject();
  return out;
}

std::string failure(std::string_view why) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("ok", false).member("error", why).endObject();
  return out;
}

bool ChangeTracker::changed(const EntryKey& key) {
  for (EntryKey& sent : sent_)
    if (sent.name == key.name) return std::exchange(sent.content, key.content) != key.content;
  sent_.push_back(key);
  return true;
}

bool ChangeTracker::changed(std::size_t entry, std::string text) {
  if (entry >= sentAlways_.size()) sentAlways_.resize(entry + 1);
  return std::exchange(sentAlways_[entry], std::move(text)) != sentAlways_[entry];
}

std::string ChangeTracker::update(const Snapshot& s, bool always) {
  const auto& entries = s.environment.entries;
  std::vector<std::uint32_t> tokens;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bool differs = false;
    if (entries[i].policy == EnvPolicy::change) {
      differs = changed(s.keys[i]);
    } else if (entries[i].policy == EnvPolicy::always && always) {
      differs = changed(i, jsonOf(Element(s.environment.predicates, entries[i].token)));
    }
    if (differs) tokens.push_back(entries[i].token);
  }
  return tokens.empty() ? std::string() : environmentMessage(s, false, tokens);
}

}  // namespace spark::web
