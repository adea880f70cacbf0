#pragma once
/// \file
/// Monitor messages as text: their shape, their numbers, and the entries of their environment.

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "spark/predicates.h"

namespace spark::test {

/// A message split into its shape and its numbers.
struct FrameText {
  std::string shape;  ///< the text, with a '#' for every number
  std::vector<double> numbers;

  explicit FrameText(const std::string& message) {
    for (std::size_t i = 0; i < message.size();) {
      std::size_t end = i;
      if (i > 0 && message[i - 1] == ' ') end = numberEnd(message, i);
      if (end == i) {
        shape += message[i++];
        continue;
      }
      numbers.push_back(std::strtod(message.c_str() + i, nullptr));
      shape += '#';
      i = end;
    }
  }

 private:
  /// The end of the number that starts at `i` and is a whole word; `i` if there is none.
  static std::size_t numberEnd(const std::string& text, std::size_t i) {
    const std::size_t end = text.find_first_not_of("0123456789+-.e", i);
    const bool isNumber = end != std::string::npos && end > i && (text[end] == ' ' || text[end] == ')') &&
                          text.find_first_of("0123456789", i) < end;
    return isNumber ? end : i;
  }
};

inline bool isFull(const std::string& message) { return message.find(")(RSG 0 1)(") != std::string::npos; }

/// The first difference of two messages: "" if their shapes are equal and all numbers are within `tolerance`.
inline std::string difference(const std::string& expected, const std::string& found, double tolerance) {
  const FrameText a(expected), b(found);
  if (a.shape != b.shape) {
    std::size_t k = 0;
    while (k < a.shape.size() && k < b.shape.size() && a.shape[k] == b.shape[k]) ++k;
    const std::size_t from = k > 40 ? k - 40 : 0;
    return "the shape: expected ..." + a.shape.substr(from, 120) + "... found ..." + b.shape.substr(from, 120) + "...";
  }
  for (std::size_t i = 0; i < a.numbers.size(); ++i)
    if (!(std::abs(a.numbers[i] - b.numbers[i]) <= tolerance))
      return "number " + std::to_string(i) + ": expected " + std::to_string(a.numbers[i]) + ", found " +
             std::to_string(b.numbers[i]);
  return {};
}

/// The value of an entry of the environment, e.g. "3" of `(play_mode 3)`; "" if the message has no such entry.
inline std::string entry(const std::string& message, const std::string& name) {
  const std::size_t end = message.find(")(R"), at = message.find("(" + name + " ");
  if (at == std::string::npos || at > end) return {};
  const std::size_t from = at + name.size() + 2;
  return message.substr(from, message.find(')', from) - from);
}

}  // namespace spark::test
