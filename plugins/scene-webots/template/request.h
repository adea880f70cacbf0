#pragma once
/// \file
/// What the program that runs templates reads and answers.
//
// A message is its length in bytes, a number of 32 bits in the byte order of the machine, and an object in JSON:
//
//   {"language": "lua", "text": "spark_write(0)...", "fields": {...}, "context": {...}}
//   {"pieces": [[0], [1, "0.5"]], "said": ["hello"]}       {"error": "line 3: ...", "said": []}
//
// A piece is a number that the program has written, and perhaps a value behind it. See template_text.h.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace spark::templates {

/// Largest size of what a template writes, and of what it prints [bytes].
inline constexpr std::size_t kMostWritten = 32 << 20, kMostSaid = 64 << 10;
/// Largest memory of a template's data [bytes].
inline constexpr std::size_t kMostMemory = 512 << 20;

struct Request {
  std::string text;
  nlohmann::json fields, context;
};

/// What a run has had as its result so far.
struct Reply {
  nlohmann::json pieces = nlohmann::json::array(), said = nlohmann::json::array();
  std::string error;
  std::size_t written = 0, printed = 0;

  /// False where it has become too much.
  bool write(double piece) {
    pieces.push_back({piece});
    return (written += 8) <= kMostWritten;
  }
  bool write(double piece, std::string value) {
    written += value.size() + 8;
    pieces.push_back({piece, std::move(value)});
    return written <= kMostWritten;
  }
  void say(std::string_view text) {
    if (printed > kMostSaid) return;
    said.push_back(std::string(text.substr(0, kMostSaid)));
    printed += text.size() + 8;
  }
};

}  // namespace spark::templates
