#include "drawings_message.h"

#include <array>

#include "stream/messages.h"

namespace spark::web {

namespace {

void writePoint(JsonWriter& json, const char* key, const Vec3f& p) {
  json.key(key).numbers(std::array{p.x(), p.y(), p.z()});
}

void writeCorners(JsonWriter& json, const std::vector<Vec3f>& points) {
  json.key("points").beginArray();
  for (const Vec3f& p : points) json.numbers(std::array{p.x(), p.y(), p.z()});
  json.endArray();
}

void writeDrawing(JsonWriter& json, const Drawing& d) {
  using Kind = Drawing::Kind;
  constexpr const char* kNames[] = {"circle", "line", "point", "sphere", "polygon", "text", "agentText"};
  const auto point = [&](std::size_t i) { return i < d.points.size() ? d.points[i] : Vec3f(0, 0, 0); };
  json.beginObject().member("kind", kNames[static_cast<int>(d.kind)]);
  switch (d.kind) {
    case Kind::circle:
      json.key("centre").numbers(std::array{point(0).x(), point(0).y()});
      json.member("radius", d.size).member("thickness", d.thickness);
      break;
    case Kind::line:
      writePoint(json, "from", point(0));
      writePoint(json, "to", point(1));
      json.member("thickness", d.thickness);
      break;
    case Kind::point:
      writePoint(json, "at", point(0));
      json.member("size", d.size);
      break;
    case Kind::sphere:
      writePoint(json, "centre", point(0));
      json.member("radius", d.size);
      break;
    case Kind::polygon:
      writeCorners(json, d.points);
      break;
    case Kind::text:
      writePoint(json, "at", point(0));
      json.member("text", d.text);
      break;
    case Kind::agentText:
      json.member("side", d.team == 1 ? "right" : "left").member("number", d.number).member("text", d.text);
      break;
  }
  json.key("colour").numbers(std::array{d.color.r, d.color.g, d.color.b, d.color.a}).endObject();
}

}  // namespace

std::string drawingsMessage(std::span<const IDrawings::Set> sets, std::uint64_t since) {
  std::string out;
  JsonWriter json(out, kWebJson);
  json.beginObject().member("type", "drawings").key("sets").beginObject();
  for (const auto& set : sets) {
    if (set.version <= since) continue;
    json.key(set.name);
    if (set.shapes.empty()) {
      json.null();
      continue;
    }
    json.beginArray();
    for (const Drawing& d : set.shapes) writeDrawing(json, d);
    json.endArray();
  }
  json.endObject().endObject();
  return out;
}

}  // namespace spark::web
