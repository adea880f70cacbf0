#include "sexp_monitor.h"

#include <array>
#include <charconv>
#include <span>

#include "spark/plugin.h"

namespace spark {

namespace {

/// Six significant digits, as C's %g.
void put(std::string& out, double v) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, v, std::chars_format::general, 6).ptr;
  out.append(digits, end);
}

template <class Range>
void putList(std::string& out, std::string_view name, const Range& numbers) {
  out.append("(").append(name);
  for (const float v : numbers) put(out += ' ', v);
  out += ')';
}

void putElement(std::string& out, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text: out.append(element.text()); return;
    case Token::Kind::number: put(out, token.number); return;
    case Token::Kind::integer: {
      char digits[24];
      out.append(digits, std::to_chars(digits, digits + sizeof digits, token.integer).ptr);
      return;
    }
    case Token::Kind::list: break;
  }
  out += '(';
  bool first = true;
  for (const Element inner : element) {
    if (!first) out += ' ';
    first = false;
    putElement(out, inner);
  }
  out += ')';
}

void putTransform(std::string& out, const FrameNode& node) { putList(out += ' ', "SLT", std::span(node.local.data(), 16)); }

void putLight(std::string& out, const IVisual& light) {
  constexpr const char* kNames[] = {"setDiffuse", "setAmbient", "setSpecular"};
  const auto colors = light.lightColors();
  for (int i = 0; i < 3; ++i) putList(out += ' ', kNames[i], std::array{colors[i].r, colors[i].g, colors[i].b, colors[i].a});
}

void putVisible(std::string& out, bool visible) { out.append(visible ? " (setVisible 1)" : " (setVisible 0)"); }

void putMesh(std::string& out, const FrameNode& node) {
  const IVisual& mesh = *node.visual;
  putVisible(out, node.visible);
  if (node.transparent) out.append(" (setTransparent)");
  out.append(" (load ").append(mesh.load()).append(") ");
  putList(out, "sSc", mesh.scale());
  const auto& materials = mesh.materials();
  if (materials.empty()) return;
  if (node.kind == FrameNode::Kind::singleMaterial) {
    out.append(" (sMat ").append(materials[0]).append(")");
    return;
  }
  out.append("(resetMaterials");  // no blank before it: monitors have always been sent it so
  for (const std::string& material : materials) out.append(" ").append(material);
  out += ')';
}

void putNode(std::string& out, const FrameNode& node, bool full, bool changed) {
  out.append("(nd");
  switch (node.kind) {
    case FrameNode::Kind::transform:
      if (full) out.append(" TRF");
      if (full || changed) putTransform(out, node);
      return;
    case FrameNode::Kind::light:
      if (full) putLight(out.append(" Light"), *node.visual);
      return;
    case FrameNode::Kind::mesh: out.append(" StaticMesh"); break;
    case FrameNode::Kind::singleMaterial: out.append(" SMN"); break;
  }
  if (full)
    putMesh(out, node);
  else if (changed)
    putVisible(out, node.visible);
}

}  // namespace

void SexpMonitor::encode(const MonitorUpdate& update, std::string& out) {
  out += '(';
  for (const std::uint32_t token : update.env) putElement(out, Element(update.frame.env.predicates, token));
  for (const Element event : update.events) putElement(out, event);
  out.append(update.full ? ")(RSG 0 1)(" : ")(RDS 0 1)(");

  int open = 0;  // nodes that are not closed yet: the ancestors of the next one, if its depth says so
  const auto closeTo = [&](int depth) {
    for (; open > depth; --open) out += ')';
  };
  for (std::size_t i = 0; i < update.frame.nodes.size(); ++i) {
    const FrameNode& node = update.frame.nodes[i];
    closeTo(node.depth);
    putNode(out, node, update.full, !update.full && update.changed[i]);
    open = node.depth + 1;
  }
  closeTo(0);
  out += ')';
}

}  // namespace spark

SPARK_PLUGIN("monitor-sexp", "1.0", "Monitor messages as S-expressions, as RoboViz reads them.", spark::SexpMonitor)
