#pragma once
/// \file
/// Messages to agents, parsed: their shape, which must be exact, and vision, which is noisy.

#include <string>
#include <string_view>
#include <vector>

namespace spark::test {

/// The top-level expressions in their exact notation. Empty if there is anything between them.
std::vector<std::string> topLevel(const std::string& message);
/// The text with every number that has decimals replaced by # and their count: `(ax -1.72)` is `(ax #2)`.
std::string shape(std::string_view text);
/// All numbers with decimals.
std::vector<double> decimals(std::string_view text);
/// "GS", "HJ hj1", "FRP rf": the head of an expression, and its name if it has one.
std::string label(const std::string& expression);
/// Removes `(unum n) (team side)`.
std::string withoutAnnouncement(std::string gs);

/// A point as seen by a robot: m, deg, deg.
struct Seen {
  double distance = 0, horizontal = 0, vertical = 0;
};
/// An item of See: `B`, `P A 3 head`, `L` (two points).
struct Item {
  std::string name;
  std::vector<Seen> points;
};
/// The items of `(See ...)`, with each part of a robot as an item.
std::vector<Item> items(const std::string& see);
/// The first error in the notation of `(See ...)`: spacing, order of items, names, decimals. "" if there is none.
std::string seeFault(const std::string& see, int decimals);

}  // namespace spark::test
