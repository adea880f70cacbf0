#include "json_monitor.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include <nlohmann/json.hpp>

#include "spark/plugin.h"

namespace spark {

namespace {

/// Six significant digits; null when not finite.
void put(std::string& out, double v) {
  if (!std::isfinite(v)) {
    out.append("null");
    return;
  }
  char digits[32];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, v, std::chars_format::general, 6).ptr);
}

void put(std::string& out, std::int64_t v) {
  char digits[24];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, v).ptr);
}

/// A JSON string; bytes that are no UTF-8 (names come from clients) become U+FFFD.
void put(std::string& out, std::string_view text) {
  const auto plain = [](unsigned char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; };
  if (std::all_of(text.begin(), text.end(), plain))
    out.append("\"").append(text).append("\"");
  else
    out.append(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

template <class Range>
void putList(std::string& out, std::string_view name, const Range& numbers) {
  put(out += '[', name);
  for (const float v : numbers) put(out += ',', double(v));
  out += ']';
}

void putElement(std::string& out, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text: put(out, element.text()); return;
    case Token::Kind::number: put(out, token.number); return;
    case Token::Kind::integer: put(out, token.integer); return;
    case Token::Kind::list: break;
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

/// A mesh name with its parameters, `StdCapsule 0.1 0.2`: the words that are numbers become numbers.
void putLoad(std::string& out, std::string_view load) {
  out.append(",[\"load\"");
  while (!load.empty()) {
    const std::size_t size = std::min(load.find(' '), load.size());
    const std::string_view word = load.substr(0, size);
    load.remove_prefix(std::min(size + 1, load.size()));
    if (word.empty()) continue;
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    out += ',';
    if (error == std::errc() && end == word.data() + word.size())
      put(out, number);
    else
      put(out, word);
  }
  out += ']';
}

void putLight(std::string& out, const IVisual& light) {
  constexpr const char* kNames[] = {"setDiffuse", "setAmbient", "setSpecular"};
  const auto colors = light.lightColors();
  for (int i = 0; i < 3; ++i) putList(out += ',', kNames[i], std::array{colors[i].r, colors[i].g, colors[i].b, colors[i].a});
}

void putVisible(std::string& out, bool visible) { out.append(visible ? ",[\"setVisible\",1]" : ",[\"setVisible\",0]"); }

void putMesh(std::string& out, const FrameNode& node) {
  const IVisual& mesh = *node.visual;
  putVisible(out, node.visible);
  if (node.transparent) out.append(",[\"setTransparent\"]");
  putLoad(out, mesh.load());
  putList(out += ',', "sSc", mesh.scale());
  const auto& materials = mesh.materials();
  if (materials.empty()) return;
  const bool single = node.kind == FrameNode::Kind::singleMaterial;
  out.append(single ? ",[\"sMat\"" : ",[\"resetMaterials\"");
  for (std::size_t i = 0; i < (single ? 1 : materials.size()); ++i) put(out += ',', std::string_view(materials[i]));
  out += ']';
}

void putNode(std::string& out, const FrameNode& node, bool full, bool changed) {
  out.append("[\"nd\"");
  switch (node.kind) {
    case FrameNode::Kind::transform:
      if (full) out.append(",\"TRF\"");
      if (full || changed) putList(out += ',', "SLT", std::span(node.local.data(), 16));
      return;
    case FrameNode::Kind::light:
      if (full) putLight(out.append(",\"Light\""), *node.visual);
      return;
    case FrameNode::Kind::mesh: out.append(",\"StaticMesh\""); break;
    case FrameNode::Kind::singleMaterial: out.append(",\"SMN\""); break;
  }
  if (full)
    putMesh(out, node);
  else if (changed)
    putVisible(out, node.visible);
}

}  // namespace

void JsonMonitor::encode(const MonitorUpdate& update, std::string& out) {
  bool first = true;
  const auto comma = [&] {
    if (!first) out += ',';
    first = false;
  };
  out.append("[[");
  for (const std::uint32_t token : update.env) comma(), putElement(out, Element(update.frame.env.predicates, token));
  for (const Element event : update.events) comma(), putElement(out, event);
  out.append(update.full ? "],[\"RSG\",0,1],[" : "],[\"RDS\",0,1],[");

  int open = 0;  // nodes that are not closed yet: the ancestors of the next one, if its depth says so
  const auto closeTo = [&](int depth) {
    for (; open > depth; --open) out += ']';
  };
  for (std::size_t i = 0; i < update.frame.nodes.size(); ++i) {
    const FrameNode& node = update.frame.nodes[i];
    closeTo(node.depth);
    if (i > 0) out += ',';
    putNode(out, node, update.full, !update.full && update.changed[i]);
    open = node.depth + 1;
  }
  closeTo(0);
  out.append("]]");
}

}  // namespace spark

SPARK_PLUGIN("monitor-json", "1.0", "Monitor messages as JSON that mirrors the S-expressions.", spark::JsonMonitor)
