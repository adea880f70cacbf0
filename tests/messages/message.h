#pragma once
/// \file
/// Messages to agents, taken apart: their shape, which must be exact, and what is seen, which is noisy.

#include <string>
#include <string_view>
#include <vector>

namespace spark::test {

/// The top-level expressions as they are written. Empty when anything stands between them.
std::vector<std::string> topLevel(const std::string& message);
/// The text with every number that has decimals replaced by # and their count: `(ax -1.72)` is `(ax #2)`.
std::string shape(std::string_view text);
/// All numbers with decimals.
std::vector<double> decimals(std::string_view text);
/// "GS", "HJ hj1", "FRP rf": head of an expression, and the name when it has one.
std::string label(const std::string& expression);
/// Without `(unum n) (team side)`.
std::string withoutAnnouncement(std::string gs);

/// A point as robots see it: m, deg, deg.
struct Seen {
  double distance = 0, horizontal = 0, vertical = 0;
};
/// An item of See: `B`, `P A 3 head`, `L` (two points).
struct Item {
  std::string name;
  std::vector<Seen> points;
};
/// The items of `(See ...)`, parts of robots one by one.
std::vector<Item> items(const std::string& see);
/// What is wrong with the writing of `(See ...)`: spacing, order of items, names, numbers' decimals. "" when nothing
/// is.
std::string seeFault(const std::string& see, int decimals);

}  // namespace spark::test
