#include "json_monitor.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "spark/json_writer.h"
#include "spark/plugin.h"

namespace spark {

namespace {

/// `["SLT",1,0,0.5]`.
void writeList(JsonWriter& json, std::string_view name, std::span<const float> numbers) {
  json.beginArray().value(name);
  for (const float v : numbers) json.value(v);
  json.endArray();
}

void write(JsonWriter& json, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text:
      json.value(element.text());
      return;
    case Token::Kind::number:
      json.value(token.number);
      return;
    case Token::Kind::integer:
      json.value(token.integer);
      return;
    case Token::Kind::list:
      break;
  }
  json.beginArray();
  for (const Element inner : element) write(json, inner);
  json.endArray();
}

/// A mesh name with parameters, `StdCapsule 0.1 0.2`; words that are numbers become numbers.
void writeLoad(JsonWriter& json, std::string_view load) {
  json.beginArray().value("load");
  while (!load.empty()) {
    const std::size_t size = std::min(load.find(' '), load.size());
    const std::string_view word = load.substr(0, size);
    load.remove_prefix(std::min(size + 1, load.size()));
    if (word.empty()) continue;
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc() && end == word.data() + word.size())
      json.value(number);
    else
      json.value(word);
  }
  json.endArray();
}

void writeLight(JsonWriter& json, const IVisual& light) {
  constexpr const char* kNames[] = {"setDiffuse", "setAmbient", "setSpecular"};
  const auto colors = light.lightColors();
  for (int i = 0; i < 3; ++i)
    writeList(json, kNames[i], std::array{colors[i].r, colors[i].g, colors[i].b, colors[i].a});
}

void writeVisible(JsonWriter& json, bool visible) {
  json.beginArray().value("setVisible").value(visible ? 1 : 0).endArray();
}

void writeMesh(JsonWriter& json, const FrameNode& node) {
  const IVisual& mesh = *node.visual;
  writeVisible(json, node.visible);
  if (node.transparent) json.beginArray().value("setTransparent").endArray();
  writeLoad(json, mesh.load());
  const Vec3f scale = mesh.scale();
  writeList(json, "sSc", {scale.data(), 3});
  const auto& materials = mesh.materials();
  if (materials.empty()) return;
  const bool single = node.kind == FrameNode::Kind::singleMaterial;
  json.beginArray().value(single ? "sMat" : "resetMaterials");
  for (std::size_t i = 0; i < (single ? 1 : materials.size()); ++i) json.value(materials[i]);
  json.endArray();
}

/// The elements of a node's array before its children.
void write(JsonWriter& json, const FrameNode& node, bool full, bool changed) {
  json.value("nd");
  switch (node.kind) {
    case FrameNode::Kind::transform:
      if (full) json.value("TRF");
      if (full || changed) writeList(json, "SLT", {node.local.data(), 16});
      return;
    case FrameNode::Kind::light:
      if (full) {
        json.value("Light");
        writeLight(json, *node.visual);
      }
      return;
    case FrameNode::Kind::mesh:
      json.value("StaticMesh");
      break;
    case FrameNode::Kind::singleMaterial:
      json.value("SMN");
      break;
  }
  if (full)
    writeMesh(json, node);
  else if (changed)
    writeVisible(json, node.visible);
}

}  // namespace

void JsonMonitor::encode(const MonitorUpdate& update, std::string& bytes) {
  JsonWriter json(bytes);
  json.beginArray().beginArray();
  for (const std::uint32_t token : update.env) write(json, Element(update.frame.env.predicates, token));
  for (const Element event : update.events) write(json, event);
  json.endArray();
  json.beginArray().value(update.full ? "RSG" : "RDS").value(0).value(1).endArray();

  json.beginArray();
  int open = 0;  // number of nodes whose array is not closed yet
  const auto closeTo = [&](int depth) {
    for (; open > depth; --open) json.endArray();
  };
  for (std::size_t i = 0; i < update.frame.nodes.size(); ++i) {
    const FrameNode& node = update.frame.nodes[i];
    closeTo(node.depth);
    json.beginArray();
    write(json, node, update.full, !update.full && update.changed[i]);
    open = node.depth + 1;
  }
  closeTo(0);
  json.endArray().endArray();
}

}  // namespace spark

SPARK_PLUGIN("monitor-json", "1.0", "Monitor messages as JSON that mirrors the S-expressions.", spark::JsonMonitor)
