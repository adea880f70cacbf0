#include "drawings_message.h"

#include <fmt/format.h>

#include "messages.h"

namespace spark::web {

namespace {

template <class... V>
void putList(std::string& out, const char* key, V... values) {
  out += fmt::format(",\"{}\":[", key);
  ((putNumber(out, values), out += ','), ...);
  out.back() = ']';
}

void putPoint(std::string& out, const char* key, const Vec3f& p) { putList(out, key, p.x(), p.y(), p.z()); }

void putCorners(std::string& out, const std::vector<Vec3f>& points) {
  out += ",\"points\":[";
  for (const Vec3f& p : points) {
    if (out.back() != '[') out += ',';
    out += '[';
    for (int i = 0; i < 3; ++i) putNumber(out, p[i]), out += ',';
    out.back() = ']';
  }
  out += ']';
}

void putText(std::string& out, const std::string& text) {
  out += ",\"text\":";
  putQuoted(out, text);
}

void putNumberAs(std::string& out, const char* key, float value) {
  out += fmt::format(",\"{}\":", key);
  putNumber(out, value);
}

void putDrawing(std::string& out, const Drawing& d) {
  using Kind = Drawing::Kind;
  constexpr const char* kNames[] = {"circle", "line", "point", "sphere", "polygon", "text", "agentText"};
  const auto point = [&](std::size_t i) { return i < d.points.size() ? d.points[i] : Vec3f(0, 0, 0); };
  out += fmt::format("{{\"kind\":\"{}\"", kNames[static_cast<int>(d.kind)]);
  switch (d.kind) {
    case Kind::circle:
      putList(out, "centre", point(0).x(), point(0).y()), putNumberAs(out, "radius", d.size),
          putNumberAs(out, "thickness", d.thickness);
      break;
    case Kind::line:
      putPoint(out, "from", point(0)), putPoint(out, "to", point(1)), putNumberAs(out, "thickness", d.thickness);
      break;
    case Kind::point:
      putPoint(out, "at", point(0)), putNumberAs(out, "size", d.size);
      break;
    case Kind::sphere:
      putPoint(out, "centre", point(0)), putNumberAs(out, "radius", d.size);
      break;
    case Kind::polygon:
      putCorners(out, d.points);
      break;
    case Kind::text:
      putPoint(out, "at", point(0)), putText(out, d.text);
      break;
    case Kind::agentText:
      out += fmt::format(",\"side\":\"{}\",\"number\":{}", d.right ? "right" : "left", d.number), putText(out, d.text);
      break;
  }
  putList(out, "colour", d.color.r, d.color.g, d.color.b, d.color.a);
  out += '}';
}

}  // namespace

std::string drawingsMessage(std::span<const IDrawings::Set> sets, std::uint64_t since) {
  std::string out = "{\"type\":\"drawings\",\"sets\":{";
  for (const auto& set : sets) {
    if (set.version <= since) continue;
    if (out.back() != '{') out += ',';
    putQuoted(out, set.name);
    out += set.shapes.empty() ? ":null" : ":[";
    for (const Drawing& d : set.shapes) {
      if (out.back() != '[') out += ',';
      putDrawing(out, d);
    }
    if (!set.shapes.empty()) out += ']';
  }
  return out += "}}";
}

}  // namespace spark::web
