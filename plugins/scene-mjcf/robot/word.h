#pragma once
/// \file
/// Tables of the elements and attributes that an importer of XML knows.

#include <algorithm>
#include <span>
#include <string_view>

namespace spark::mjcf {

/// What an element may have, and in which elements it may be. Lists are words with a blank between them.
struct Word {
  std::string_view element;
  std::string_view in;    ///< the elements around it, written as the importer writes them
  std::string_view read;  ///< attributes that are read, or named where their values are not supported
  std::string_view idle;  ///< attributes that are no part of a simulation
  enum Content {
    elements,
    text,
    foreign  ///< its reader names what it does not take, or all of it is named
  } content = elements;
  bool repeats = false;  ///< there may be several, in a language where the first one counts otherwise

  bool knows(std::string_view attribute) const { return holds(read, attribute) || holds(idle, attribute); }

  static bool holds(std::string_view list, std::string_view word) {
    while (!list.empty()) {
      const std::size_t end = std::min(list.find(' '), list.size());
      if (list.substr(0, end) == word) return true;
      list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
  }
};

/// The word of an element in another one; nullptr where the table has none.
inline const Word* wordOf(std::span<const Word> table, std::string_view element, std::string_view in) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Word& w) {
    return w.element == element && (w.in == in || Word::holds(w.in, in));
  });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace spark::mjcf
