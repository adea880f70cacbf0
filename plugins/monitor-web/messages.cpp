#include "messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace spark::web {

namespace {

template <class... A>
void put(std::string& out, fmt::format_string<A...> f, A&&... a) {
  fmt::format_to(std::back_inserter(out), f, std::forward<A>(a)...);
}

template <class List>
void putNumbers(std::string& out, const List& numbers) {
  out += '[';
  for (const double v : numbers) putNumber(out, v), out += ',';
  out.back() == ',' ? void(out.back() = ']') : out.push_back(']');
}

void putShape(std::string& out, const SceneShape& shape) {
  constexpr const char* kNames[] = {"box", "sphere", "capsule", "cylinder"};
  put(out, "{{\"kind\":\"{}\",\"size\":", kNames[static_cast<int>(shape.kind)]);
  putNumbers(out, shape.size);
  out += ",\"position\":";
  putNumbers(out, std::array{shape.position.x(), shape.position.y(), shape.position.z()});
  out += ",\"rotation\":";
  putNumbers(out, shape.rotation);
  out += '}';
}

void putTransform(std::string& out, const NodeDescription& node) {
  out += ",\"kind\":\"transform\"";
  if (!node.path.empty()) {
    out += ",\"path\":";
    putQuoted(out, node.path);
  }
  if (node.shapes.empty()) return;
  out += ",\"shapes\":[";
  for (const SceneShape& shape : node.shapes) putShape(out, shape), out += ',';
  out.back() = ']';
}

void putMesh(std::string& out, const NodeDescription& node, bool visible) {
  out += ",\"kind\":\"mesh\",\"load\":";
  putQuoted(out, node.load);
  out += ",\"scale\":";
  putNumbers(out, std::array<double, 3>{node.scale.x(), node.scale.y(), node.scale.z()});
  if (!node.materials.empty()) {
    out += ",\"materials\":[";
    for (const std::string& name : node.materials) putQuoted(out, name), out += ',';
    out.back() = ']';
  }
  if (node.transparent) out += ",\"transparent\":true";
  put(out, ",\"visible\":{}", visible);
}

void putNode(std::string& out, const NodeDescription& node, bool visible) {
  put(out, "{{\"parent\":{}", node.parent);
  switch (node.kind) {
    case FrameNode::Kind::transform:
      putTransform(out, node);
      break;
    case FrameNode::Kind::light:
      out += ",\"kind\":\"light\"";
      break;
    case FrameNode::Kind::mesh:
    case FrameNode::Kind::singleMaterial:
      putMesh(out, node, visible);
      break;
  }
  out += '}';
}

/// Recorded games know only texts.
bool isNumber(std::string_view text) {
  if (text.find_first_not_of("0123456789+-.eE") != text.npos) return false;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

std::string environment(const Snapshot& s, bool full, const std::vector<std::uint32_t>& tokens) {
  std::string out = "{\"type\":\"environment\",\"time\":";
  putNumber(out, s.time, 10);
  if (full) out += ",\"full\":true";
  out += ",\"entries\":[";
  for (const std::uint32_t token : tokens) putElement(out, Element(s.environment.predicates, token)), out += ',';
  if (!tokens.empty()) out.pop_back();
  return out += "]}";
}

}  // namespace

void putQuoted(std::string& out, std::string_view text) {
  const auto plain = [](unsigned char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; };
  if (std::all_of(text.begin(), text.end(), plain))
    put(out, "\"{}\"", text);
  else
    out += nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

void putNumber(std::string& out, double value, int digits) {
  if (std::isfinite(value))
    put(out, "{:.{}g}", value, digits);
  else
    out += '0';
}

void putElement(std::string& out, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text:
      return isNumber(element.text()) ? putNumber(out, element.number(), 10) : putQuoted(out, element.text());
    case Token::Kind::number:
      return putNumber(out, token.number, 10);
    case Token::Kind::integer:
      return put(out, "{}", token.integer);
    case Token::Kind::list:
      break;
  }
  out += '[';
  bool first = true;
  for (const Element inner : element) {
    if (!first) out += ',';
    first = false;
    putElement(out, inner);
  }
  out += ']';
}

std::string helloMessage(double step, double rate) {
  return fmt::format("{{\"type\":\"hello\",\"protocol\":1,\"spark\":\"{}\",\"step\":{:g},\"rate\":{:g}}}",
                     SPARK_VERSION, step, rate);
}

std::string sceneMessage(const Snapshot& s, std::uint32_t shape) {
  std::string out = fmt::format("{{\"type\":\"scene\",\"shape\":{},\"nodes\":[", shape);
  const auto& nodes = s.scene->nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0) out += ',';
    putNode(out, nodes[i], s.visible[i]);
  }
  out += "],\"local\":[";
  for (const Matrix& m : s.transforms)
    for (int k = 0; k < 16; ++k) putNumber(out, m.data()[k]), out += ',';
  if (!s.transforms.empty()) out.pop_back();
  return out += "]}";
}

std::string fullEnvironmentMessage(const Snapshot& s) {
  std::vector<std::uint32_t> tokens;
  for (const Environment::Entry& entry : s.environment.entries)
    if (entry.policy != EnvPolicy::once) tokens.push_back(entry.token);
  return environment(s, true, tokens);
}

std::string eventMessage(double time, const Element& event) {
  std::string out = "{\"type\":\"event\",\"time\":";
  putNumber(out, time, 10);
  out += ",\"entry\":";
  putElement(out, event);
  return out += '}';
}

std::string reply(std::string_view type, std::int64_t id, std::string_view answer) {
  return fmt::format("{{\"type\":\"{}\",\"id\":{},{}", type, id, answer.substr(1));
}

std::string failure(std::string_view why) {
  std::string out = "{\"ok\":false,\"error\":";
  putQuoted(out, why);
  return out += '}';
}

bool EnvironmentDiary::changed(const EntryKey& key) {
  for (EntryKey& told : told_)
    if (told.name == key.name) return std::exchange(told.content, key.content) != key.content;
  told_.push_back(key);
  return true;
}

bool EnvironmentDiary::changed(std::size_t entry, std::string text) {
  if (entry >= toldAlways_.size()) toldAlways_.resize(entry + 1);
  return std::exchange(toldAlways_[entry], std::move(text)) != toldAlways_[entry];
}

std::string EnvironmentDiary::take(const Snapshot& s, bool always) {
  const auto& entries = s.environment.entries;
  std::vector<std::uint32_t> tokens;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bool differs = false;
    if (entries[i].policy == EnvPolicy::change) {
      differs = changed(s.keys[i]);
    } else if (entries[i].policy == EnvPolicy::always && always) {
      std::string text;
      putElement(text, Element(s.environment.predicates, entries[i].token));
      differs = changed(i, std::move(text));
    }
    if (differs) tokens.push_back(entries[i].token);
  }
  return tokens.empty() ? std::string() : environment(s, false, tokens);
}

}  // namespace spark::web
