#include "draw_packet.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace spark::drawing {

namespace {
constexpr std::size_t kDigits = 6;  // characters of a number
constexpr std::uint8_t kRight = 128;

using Kind = Drawing::Kind;

/// Number of bytes of the UTF-8 character at the start; 0 if it is invalid. `bytes` is not empty.
std::size_t characterAt(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  const std::uint8_t first = at(0);
  const std::size_t n = first < 0x80                    ? 1
                        : first >= 0xc2 && first < 0xe0 ? 2
                        : first >= 0xe0 && first < 0xf0 ? 3
                        : first >= 0xf0 && first < 0xf5 ? 4
                                                        : 0;
  if (n == 0 || n > bytes.size()) return 0;
  for (std::size_t i = 1; i < n; ++i)
    if ((at(i) & 0xc0) != 0x80) return 0;
  if (first == 0xe0 && at(1) < 0xa0) return 0;  // overlong encoding
  if (first == 0xed && at(1) > 0x9f) return 0;  // surrogates
  if ((first == 0xf0 && at(1) < 0x90) || (first == 0xf4 && at(1) > 0x8f)) return 0;
  return n;
}

}  // namespace

std::string cleanText(std::string_view bytes, std::size_t maxBytes) {
  std::string out;
  while (!bytes.empty()) {
    const std::size_t n = characterAt(bytes);
    const auto first = static_cast<std::uint8_t>(bytes[0]);
    const std::string_view character = n == 0 ? "?" : first < ' ' || first == 127 ? " " : bytes.substr(0, n);
    if (out.size() + character.size() > maxBytes) break;
    out += character;
    bytes.remove_prefix(std::max<std::size_t>(n, 1));
  }
  return out;
}

// ---- reading: a missing or invalid argument is zero and sets failed_ ----

bool PacketReader::next(Command& out) {
  if (rest_.empty() || failed_) return false;
  out = {};
  if (!read(out)) failed_ = true;
  return !failed_;
}

bool PacketReader::read(Command& out) {
  const std::uint8_t what = byte(), type = byte();
  if (what == 0 && type == 0) {
    out.kind = Command::Kind::swap;
    out.set = text(kMaxNameBytes);
    return true;
  }
  if (what == 1) {
    out.kind = Command::Kind::draw;
    if (!readShape(type, out.drawing)) return false;
    out.set = text(kMaxNameBytes);
    return true;
  }
  if (what == 2) return readText(type, out);
  if (what != 3 || type != 0) return false;
  byte();
  return true;
}

bool PacketReader::readShape(std::uint8_t type, Drawing& out) {
  switch (type) {
    case 0: {
      out.kind = Kind::circle;
      const float x = number(), y = number();
      out.points = {{x, y, 0}};
      out.size = length();
      out.thickness = length();
      break;
    }
    case 1:
      out.kind = Kind::line;
      out.points.push_back(point());
      out.points.push_back(point());
      out.thickness = length();
      break;
    case 2:
    case 3:
      out.kind = type == 2 ? Kind::point : Kind::sphere;
      out.points.push_back(point());
      out.size = length();
      break;
    case 4: {
      out.kind = Kind::polygon;
      const int corners = byte();
      out.color = color(true);
      for (int i = 0; i < corners && !failed_; ++i) out.points.push_back(point());
      return true;
    }
    default:
      return false;
  }
  out.color = color();
  return true;
}

bool PacketReader::readText(std::uint8_t type, Command& out) {
  Drawing& d = out.drawing;
  if (type > 2) return false;
  d.kind = type == 0 ? Kind::text : Kind::agentText;
  out.kind = type == 0 ? Command::Kind::draw : Command::Kind::agentText;
  if (type == 0)
    d.points.push_back(point());
  else
    readAgent(d);
  if (type == 2) return true;
  d.color = color();
  d.text = text(kMaxTextBytes);
  if (type == 0) out.set = text(kMaxNameBytes);
  return true;
}

std::uint8_t PacketReader::byte() {
  if (rest_.empty()) return failed_ = true, 0;
  const auto b = static_cast<std::uint8_t>(rest_.front());
  rest_ = rest_.subspan(1);
  return b;
}

float PacketReader::number() {
  if (rest_.size() < kDigits) return failed_ = true, 0.f;
  char digits[kDigits];
  std::memcpy(digits, rest_.data(), kDigits);
  rest_ = rest_.subspan(kDigits);
  const char *begin = digits, *end = digits + kDigits;
  while (begin < end && (*begin == ' ' || *begin == '+')) ++begin;
  while (end > begin && end[-1] == ' ') --end;
  float v = 0;
  const auto [parsed, wrong] = std::from_chars(begin, end, v);
  if (wrong != std::errc() || parsed != end || !(std::abs(v) <= kMaxCoordinate)) return failed_ = true, 0.f;
  return v;
}

float PacketReader::length() { return std::max(0.f, number()); }

Vec3f PacketReader::point() {
  const float x = number(), y = number(), z = number();
  return {x, y, z};
}

Color PacketReader::color(bool alpha) {
  Color c;
  for (float* channel : {&c.r, &c.g, &c.b}) *channel = static_cast<float>(byte()) / 255.f;
  if (alpha) c.a = static_cast<float>(byte()) / 255.f;
  return c;
}

std::string PacketReader::text(std::size_t maxBytes) {
  const auto end = std::find(rest_.begin(), rest_.end(), std::byte{0});
  if (end == rest_.end()) return failed_ = true, std::string();
  const std::string_view bytes(reinterpret_cast<const char*>(rest_.data()),
                               static_cast<std::size_t>(end - rest_.begin()));
  rest_ = rest_.subspan(bytes.size() + 1);
  return cleanText(bytes, maxBytes);
}

void PacketReader::readAgent(Drawing& out) {
  const std::uint8_t agent = byte();
  out.team = agent / kRight;
  out.number = agent % kRight + 1;
}

// ---- writing ----

namespace {

void put(std::string& out, int byte) { out += static_cast<char>(byte); }

void putNumber(std::string& out, float v) {
  constexpr float kMax = 99999;  // fits into six characters
  char text[64];
  std::snprintf(text, sizeof text, "%6f", static_cast<double>(std::isfinite(v) ? std::clamp(v, -kMax, kMax) : 0));
  out.append(text, kDigits);
}

void putPoint(std::string& out, const Vec3f& p) {
  for (int i = 0; i < 3; ++i) putNumber(out, p[i]);
}

void putColor(std::string& out, const Color& c, bool alpha = false) {
  const auto channel = [&](float v) { put(out, static_cast<int>(std::lround(255 * std::clamp(v, 0.f, 1.f)))); };
  channel(c.r), channel(c.g), channel(c.b);
  if (alpha) channel(c.a);
}

void putText(std::string& out, std::string_view text) { out.append(text.substr(0, text.find('\0'))), put(out, 0); }

void putAgentText(std::string& out, const Drawing& d) {
  put(out, 2), put(out, d.text.empty() ? 2 : 1);
  put(out, d.number - 1 + kRight * d.team);
  if (d.text.empty()) return;
  putColor(out, d.color);
  putText(out, d.text);
}

}  // namespace

void writeDrawing(const Drawing& d, std::string_view set, std::string& out) {
  constexpr std::size_t kMaxCorners = 255;
  switch (d.kind) {
    case Kind::circle:
      put(out, 1), put(out, 0), putNumber(out, d.points[0].x()), putNumber(out, d.points[0].y()),
          putNumber(out, d.size), putNumber(out, d.thickness);
      break;
    case Kind::line:
      put(out, 1), put(out, 1), putPoint(out, d.points[0]), putPoint(out, d.points[1]), putNumber(out, d.thickness);
      break;
    case Kind::point:
    case Kind::sphere:
      put(out, 1), put(out, d.kind == Kind::point ? 2 : 3), putPoint(out, d.points[0]), putNumber(out, d.size);
      break;
    case Kind::polygon: {
      const std::size_t corners = std::min(d.points.size(), kMaxCorners);
      put(out, 1), put(out, 4), put(out, static_cast<int>(corners)), putColor(out, d.color, true);
      for (std::size_t i = 0; i < corners; ++i) putPoint(out, d.points[i]);
      return putText(out, set);
    }
    case Kind::text:
      put(out, 2), put(out, 0), putPoint(out, d.points[0]), putColor(out, d.color), putText(out, d.text);
      return putText(out, set);
    case Kind::agentText:
      return putAgentText(out, d);
  }
  putColor(out, d.color);
  putText(out, set);
}

void writeSwap(std::string_view prefix, std::string& out) {
  put(out, 0), put(out, 0);
  putText(out, prefix);
}

}  // namespace spark::drawing
