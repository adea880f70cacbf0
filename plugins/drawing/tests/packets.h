#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spark::test {

/// The bytes of a packet. Numbers of six characters are appended as text.
inline std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (int v : values) out += static_cast<char>(v);
  return out;
}
inline std::string zero(std::string text) { return text += '\0'; }

inline std::span<const std::byte> packet(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// A red sphere of radius 0.5 at (1, 2, 3) in a set.
inline std::string sphere(const std::string& set) {
  return bytes({1, 3}) + "1.00002.00003.00000.5000" + bytes({255, 0, 0}) + zero(set);
}
inline std::string swap(const std::string& prefix) { return bytes({0, 0}) + zero(prefix); }

}  // namespace spark::test
