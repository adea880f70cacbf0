#include "sexp_monitor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>

#include "spark/numbers.h"
#include "spark/plugin.h"

namespace spark {

namespace {

/// Writes each number after a blank: ` 1 0 0.5`.
void putNumbers(ByteWriter& out, std::span<const float> numbers) {
  char* at = out.room(numbers.size() * (1 + kGeneralRoom));
  for (const float v : numbers) {
    *at++ = ' ';
    at = putGeneral(at, v);
  }
  out.end(at);
}

/// `(name 1 0 0.5)`.
void putList(ByteWriter& out, std::string_view name, std::span<const float> numbers) {
  out.put('(');
  out.put(name);
  putNumbers(out, numbers);
  out.put(')');
}

void putElement(ByteWriter& out, const Element& element) {
  const Token& token = element.token();
  switch (token.kind) {
    case Token::Kind::text:
      return out.put(element.text());
    case Token::Kind::number:
      return out.general(token.number);
    case Token::Kind::integer:
      return out.integer(token.integer);
    case Token::Kind::list:
      break;
  }
  out.put('(');
  bool first = true;
  for (const Element inner : element) {
    if (!first) out.put(' ');
    first = false;
    putElement(out, inner);
  }
  out.put(')');
}

/// Writes a matrix column by column. Two common cases are faster: no rotation, as for most parts of a robot, and
/// columns that end with 0 or 1, as in all matrices of rigid transforms.
void putTransform(ByteWriter& out, const Matrix& matrix) {
  constexpr float kNoRotation[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  out.put(" (SLT");
  int column = 0;
  // The same bits are meant: -0 is written as such.
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  if (std::memcmp(matrix.data(), kNoRotation, sizeof kNoRotation) == 0) {
    out.put(" 1 0 0 0 0 1 0 0 0 0 1 0");
    column = 3;
  }
  for (; column < 4; ++column) {
    const float* v = matrix.data() + 4 * column;
    const bool rigid = std::bit_cast<std::uint32_t>(v[3]) == std::bit_cast<std::uint32_t>(column == 3 ? 1.0f : 0.0f);
    putNumbers(out, {v, rigid ? 3u : 4u});
    if (rigid) out.put(column == 3 ? " 1" : " 0");
  }
  out.put(')');
}

void putLight(ByteWriter& out, const IVisual& light) {
  constexpr const char* kNames[] = {"setDiffuse", "setAmbient", "setSpecular"};
  const auto colors = light.lightColors();
  for (int i = 0; i < 3; ++i) {
    out.put(' ');
    putList(out, kNames[i], std::array{colors[i].r, colors[i].g, colors[i].b, colors[i].a});
  }
}

void putVisible(ByteWriter& out, bool visible) { out.put(visible ? " (setVisible 1)" : " (setVisible 0)"); }

/// Usually the three numbers are equal; equal ones are formatted once.
void putScale(ByteWriter& out, const Vec3f& scale) {
  char text[1 + kGeneralRoom] = " ";
  std::size_t size = 0;
  out.put("(sSc");
  for (int i = 0; i < 3; ++i) {
    if (i == 0 || std::bit_cast<std::uint32_t>(scale[i]) != std::bit_cast<std::uint32_t>(scale[i - 1]))
      size = static_cast<std::size_t>(putGeneral(text + 1, scale[i]) - text);
    out.put({text, std::min(size, sizeof text)});
  }
  out.put(')');
}

void putMesh(ByteWriter& out, const FrameNode& node) {
  const IVisual& mesh = *node.visual;
  putVisible(out, node.visible);
  if (node.transparent) out.put(" (setTransparent)");
  out.put(" (load ");
  out.put(mesh.load());
  out.put(") ");
  putScale(out, mesh.scale());
  const auto& materials = mesh.materials();
  if (materials.empty()) return;
  if (node.kind == FrameNode::Kind::singleMaterial) {
    out.put(" (sMat ");
    out.put(materials[0]);
    return out.put(')');
  }
  out.put("(resetMaterials");  // without a blank before it, as SimSpark writes it
  for (const std::string& material : materials) {
    out.put(' ');
    out.put(material);
  }
  out.put(')');
}

void putNode(ByteWriter& out, const FrameNode& node, bool full, bool changed) {
  out.put("(nd");
  switch (node.kind) {
    case FrameNode::Kind::transform:
      if (full) out.put(" TRF");
      if (full || changed) putTransform(out, node.local);
      return;
    case FrameNode::Kind::light:
      if (full) {
        out.put(" Light");
        putLight(out, *node.visual);
      }
      return;
    case FrameNode::Kind::mesh:
      out.put(" StaticMesh");
      break;
    case FrameNode::Kind::singleMaterial:
      out.put(" SMN");
      break;
  }
  if (full)
    putMesh(out, node);
  else if (changed)
    putVisible(out, node.visible);
}

}  // namespace

void SexpMonitor::encode(const MonitorUpdate& update, std::string& bytes) {
  ByteWriter out(bytes);
  out.put('(');
  for (const std::uint32_t token : update.env) putElement(out, Element(update.frame.env.predicates, token));
  for (const Element event : update.events) putElement(out, event);
  out.put(update.full ? ")(RSG 0 1)(" : ")(RDS 0 1)(");

  int open = 0;  // number of nodes whose list is not closed yet
  const auto closeTo = [&](int depth) {
    for (; open > depth; --open) out.put(')');
  };
  for (std::size_t i = 0; i < update.frame.nodes.size(); ++i) {
    const FrameNode& node = update.frame.nodes[i];
    closeTo(node.depth);
    putNode(out, node, update.full, !update.full && update.changed[i]);
    open = node.depth + 1;
  }
  closeTo(0);
  out.put(')');
}

}  // namespace spark

SPARK_PLUGIN("monitor-sexp", "1.0", "Monitor messages as S-expressions, as RoboViz reads them.", spark::SexpMonitor)
