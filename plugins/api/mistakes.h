#pragma once
/// \file
/// The kinds of mistakes that an agent, or the sender of commands, has made. Most mistakes are repeated in every cycle;
/// the log names each kind once.

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "spark/abi/api/mistakes.h"

namespace spark {

/// Remembers at most kMax kinds. Any thread, one at a time.
class Mistakes {
 public:
  /// The number of kinds that it remembers.
  static constexpr std::size_t kMax = 200;

  /// The kind of a mistake about `subject`, usually a predicate, that `text` describes. Texts that differ only in
  /// numbers and in what they quote ('...') are of one kind.
  static std::uint64_t kindOf(std::string_view subject, std::string_view text) {
    std::uint64_t hash = 14695981039346656037ull;  // FNV-1a
    const auto add = [&hash](char c) { hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull; };
    for (const char c : subject) add(c);
    add('\0');
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool quote = text[i] == '\'', number = isDigit(text, i) || (isSign(text[i]) && isDigit(text, i + 1));
      add(number ? '#' : text[i]);
      if (quote) i = std::min(text.find('\'', i + 1), text.size());
      if (number) i = std::min(text.find_first_not_of("0123456789.e+-", i + 1), text.size()) - 1;
    }
    return hash;
  }

  /// True for a kind that was added.
  bool known(std::uint64_t kind) const { return std::binary_search(kinds_.begin(), kinds_.end(), kind); }
  /// True if no more kinds can be added.
  bool full() const { return kinds_.size() >= kMax; }
  /// Adds a kind, unless it is known or there is no room.
  void add(std::uint64_t kind) {
    if (!full() && !known(kind)) kinds_.insert(std::lower_bound(kinds_.begin(), kinds_.end(), kind), kind);
  }

 private:
  static bool isDigit(std::string_view text, std::size_t i) {
    return i < text.size() && text[i] >= '0' && text[i] <= '9';
  }
  static bool isSign(char c) { return c == '-' || c == '+'; }

  std::vector<std::uint64_t> kinds_;  ///< ascending
};

}  // namespace spark
