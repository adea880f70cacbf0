#include "shape_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "draw_packet.h"

namespace spark::drawing {

namespace {
using Kind = Drawing::Kind;
constexpr std::size_t kMaxCorners = 255;

/// Reads one shape; keeps the first error.
class ShapeReader {
 public:
  ShapeReader(const Element& list, Drawing& out) : list_(list), out_(out) {}

  std::string read() {
    out_ = {};
    const std::string_view name = list_.head();
    if (name == "circle")
      shape(Kind::circle), points("at", 2), number("radius", out_.size, true), thickness();
    else if (name == "line")
      shape(Kind::line), points("from", 3), points("to", 3), thickness();
    else if (name == "point")
      shape(Kind::point), points("at", 3), out_.size = kPointSize, number("size", out_.size, false);
    else if (name == "sphere")
      shape(Kind::sphere), points("at", 3), number("radius", out_.size, true);
    else if (name == "polygon")
      shape(Kind::polygon), corners();
    else if (name == "text")
      shape(Kind::text), points("at", 3), say(true);
    else if (name == "agent")
      shape(Kind::agentText), agent(), say(false);
    else
      return fmt::format("expected a circle, line, point, sphere, polygon, text or agent, found '{}'", name);
    color();
    return std::move(wrong_);
  }

 private:
  static constexpr float kPointSize = 5;  // pixels

  void shape(Kind kind) { out_.kind = kind; }
  void expect(std::string_view what) {
    if (wrong_.empty()) wrong_ = fmt::format("expected {} in ({} ...)", what, list_.head());
  }
  static bool inRange(double v) { return std::abs(v) <= static_cast<double>(PacketReader::kMaxCoordinate); }

  bool point(const Element& e, int count) {
    Vec3f p = Vec3f::Zero();
    if (e.size() < static_cast<std::size_t>(count) + 1) return false;
    for (int i = 0; i < count; ++i) {
      const auto v = e.at(static_cast<std::size_t>(i) + 1).asNumber();
      if (!v || !inRange(*v)) return false;
      p[i] = static_cast<float>(*v);
    }
    out_.points.push_back(p);
    return true;
  }
  void points(const char* name, int count) {
    if (const Element e = list_.named(name); !e || !point(e, count))
      expect(fmt::format("({} {}) with numbers below {}", name, count == 2 ? "x y" : "x y z",
                         PacketReader::kMaxCoordinate));
  }
  void corners() {
    for (const Element e : list_)
      if (e.head() == "at" && out_.points.size() < kMaxCorners && !point(e, 3)) return expect("corners (at x y z)");
    if (out_.points.size() < 3) expect("at least three corners (at x y z)");
  }
  void number(const char* name, float& to, bool required) {
    const Element e = list_.named(name);
    if (!e) return required ? expect(fmt::format("({} number)", name)) : void();
    const auto v = e.at(1).asNumber();
    if (!v || !(*v >= 0) || !inRange(*v)) return expect(fmt::format("({} number), not below 0", name));
    to = static_cast<float>(*v);
  }
  void thickness() { number("thickness", out_.thickness, false); }
  void say(bool required) {
    const Element e = list_.named("say");
    if (!e) return required ? expect("(say text)") : void();
    out_.text = cleanText(e.at(1).text(), PacketReader::kMaxTextBytes);
  }
  void agent() {
    const Element side = list_.named("side"), index = list_.named("unum");
    const std::string_view where = side ? side.at(1).text() : std::string_view();
    const std::int64_t number = index ? index.at(1).integer() : 0;
    if ((where != "left" && where != "right") || number < 1 || number > 128)
      return expect("(side left) or (side right), and (unum 1) to (unum 128)");
    out_.team = where == "right" ? 1 : 0;
    out_.number = static_cast<int>(number);
  }
  void color() {
    out_.color = {1, 1, 1, 1};
    const Element e = list_.named("color");
    if (!e) return;
    if (e.size() < 4) return expect("(color red green blue), 0 to 255");
    float* channels[] = {&out_.color.r, &out_.color.g, &out_.color.b, &out_.color.a};
    for (std::size_t i = 0; i < 4 && i + 1 < e.size(); ++i) {
      const double v = e.at(i + 1).number();
      *channels[i] = std::isfinite(v) ? static_cast<float>(std::clamp(v, 0.0, 255.0) / 255) : 0;
    }
    if (out_.kind != Kind::polygon) out_.color.a = 1;
  }

  const Element list_;
  Drawing& out_;
  std::string wrong_;
};
}  // namespace

std::string readShape(const Element& list, Drawing& out) { return ShapeReader(list, out).read(); }

}  // namespace spark::drawing
