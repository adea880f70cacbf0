#include "json_monitor.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "spark/numbers.h"
#include "spark/plugin.h"

namespace spark {

namespace {

/// Six significant digits; null when not finite.
void put(ByteWriter& out, double v) {
  if (std::isfinite(v))
    out.general(v);
  else
    out.put("null");
}

void put(ByteWriter& out, std::int64_t v) { out.integer(v); }

/// A JSON string; bytes that are no UTF-8 (names come from clients) become U+FFFD.
void put(ByteWriter& out, std::string_view text) {
  const auto plain = [](unsigned char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; };
  if (!std::all_of(text.begin(), text.end(), plain))
    return out.put(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  out.put('"');
  out.put(text);
  out.put('"');
}

/// `,["SLT",1,0,0.5]`.
void putList(ByteWriter& out, std::string_view name, std::span<const float> numbers) {
  out.put(",[");
  put(out, name);
  for (const float v : numbers) {
    out.put(',');
    put(out, static_cast<double>(v));
  }
  out.put(']');
}

void putElement(ByteWriter& out, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text:
      return put(out, element.text());
    case Token::Kind::number:
      return put(out, token.number);
    case Token::Kind::integer:
      return put(out, token.integer);
    case Token::Kind::list:
      break;
  }
  out.put('[');
  bool first = true;
  for (const Element inner : element) {
    if (!first) out.put(',');
    first = false;
    putElement(out, inner);
  }
  out.put(']');
}

/// A mesh name with its parameters, `StdCapsule 0.1 0.2`: the words that are numbers become numbers.
void putLoad(ByteWriter& out, std::string_view load) {
  out.put(",[\"load\"");
  while (!load.empty()) {
    const std::size_t size = std::min(load.find(' '), load.size());
    const std::string_view word = load.substr(0, size);
    load.remove_prefix(std::min(size + 1, load.size()));
    if (word.empty()) continue;
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    out.put(',');
    if (error == std::errc() && end == word.data() + word.size())
      put(out, number);
    else
      put(out, word);
  }
  out.put(']');
}

void putLight(ByteWriter& out, const IVisual& light) {
  constexpr const char* kNames[] = {"setDiffuse", "setAmbient", "setSpecular"};
  const auto colors = light.lightColors();
  for (int i = 0; i < 3; ++i) putList(out, kNames[i], std::array{colors[i].r, colors[i].g, colors[i].b, colors[i].a});
}

void putVisible(ByteWriter& out, bool visible) { out.put(visible ? ",[\"setVisible\",1]" : ",[\"setVisible\",0]"); }

void putMesh(ByteWriter& out, const FrameNode& node) {
  const IVisual& mesh = *node.visual;
  putVisible(out, node.visible);
  if (node.transparent) out.put(",[\"setTransparent\"]");
  putLoad(out, mesh.load());
  const Vec3f scale = mesh.scale();
  putList(out, "sSc", {scale.data(), 3});
  const auto& materials = mesh.materials();
  if (materials.empty()) return;
  const bool single = node.kind == FrameNode::Kind::singleMaterial;
  out.put(single ? ",[\"sMat\"" : ",[\"resetMaterials\"");
  for (std::size_t i = 0; i < (single ? 1 : materials.size()); ++i) {
    out.put(',');
    put(out, std::string_view(materials[i]));
  }
  out.put(']');
}

void putNode(ByteWriter& out, const FrameNode& node, bool full, bool changed) {
  out.put("[\"nd\"");
  switch (node.kind) {
    case FrameNode::Kind::transform:
      if (full) out.put(",\"TRF\"");
      if (full || changed) putList(out, "SLT", {node.local.data(), 16});
      return;
    case FrameNode::Kind::light:
      if (full) {
        out.put(",\"Light\"");
        putLight(out, *node.visual);
      }
      return;
    case FrameNode::Kind::mesh:
      out.put(",\"StaticMesh\"");
      break;
    case FrameNode::Kind::singleMaterial:
      out.put(",\"SMN\"");
      break;
  }
  if (full)
    putMesh(out, node);
  else if (changed)
    putVisible(out, node.visible);
}

}  // namespace

void JsonMonitor::encode(const MonitorUpdate& update, std::string& bytes) {
  ByteWriter out(bytes);
  bool first = true;
  const auto comma = [&] {
    if (!first) out.put(',');
    first = false;
  };
  out.put("[[");
  for (const std::uint32_t token : update.env) comma(), putElement(out, Element(update.frame.env.predicates, token));
  for (const Element event : update.events) comma(), putElement(out, event);
  out.put(update.full ? "],[\"RSG\",0,1],[" : "],[\"RDS\",0,1],[");

  int open = 0;  // nodes that are not closed yet: the ancestors of the next one, if its depth says so
  const auto closeTo = [&](int depth) {
    for (; open > depth; --open) out.put(']');
  };
  for (std::size_t i = 0; i < update.frame.nodes.size(); ++i) {
    const FrameNode& node = update.frame.nodes[i];
    closeTo(node.depth);
    if (i > 0) out.put(',');
    putNode(out, node, update.full, !update.full && update.changed[i]);
    open = node.depth + 1;
  }
  closeTo(0);
  out.put("]]");
}

}  // namespace spark

SPARK_PLUGIN("monitor-json", "1.0", "Monitor messages as JSON that mirrors the S-expressions.", spark::JsonMonitor)
