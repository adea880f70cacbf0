#pragma once
/// \file
/// The sets of drawings.

#include <array>
#include <bitset>
#include <vector>

#include "api/drawing.h"

namespace spark::drawing {

/// Named sets of drawings, each double-buffered: shapes are added to the back buffer, and swap() shows it and empties
/// it. Agents' texts are in a set of their own and shown at once.
///
/// Drawings come from untrusted sources, so their number is limited; what exceeds the limits is refused.
class DrawBoard {
 public:
  using Set = IDrawings::Set;
  static constexpr std::size_t kMaxSets = 256;
  static constexpr std::size_t kMaxShapes = 1024;           ///< in a buffer
  static constexpr std::size_t kMaxPoints = 8192;           ///< in all buffers; a shape without points counts as one
  static constexpr std::size_t kMaxRecordBytes = 1u << 20;  ///< record() adds no further sets beyond it
  /// Name of the set of agents' texts; it has no other shapes.
  static constexpr const char* kAgents = "agents";

  /// As IDrawings::version().
  std::uint64_t version() const { return version_; }
  /// As IDrawings::sets().
  std::span<const Set> sets() const { return shown_; }

  /// Adds a shape to the back buffer of a set. False if a limit is reached.
  bool add(std::string_view set, Drawing drawing);
  /// Swaps the buffers of all sets whose names begin with `prefix`.
  void swap(std::string_view prefix);
  /// Replaces the shown shapes of a set. Returns the number of shapes that were refused.
  std::size_t show(std::string_view set, std::vector<Drawing> shapes);
  /// Sets the text of an agent; an empty text removes it.
  void setAgentText(const Drawing& text);
  /// Removes all drawings.
  void clear();
  /// As IDrawings::record().
  void record(std::uint64_t since, std::string& out) const;

 private:
  /// Index of a set, which is created if needed; the number of sets if a limit is reached.
  std::size_t indexOf(std::string_view set);
  bool makeRoom();
  void replace(std::size_t i, std::vector<Drawing> shapes);
  /// Number of points, at least 1: what counts for kMaxPoints.
  static std::size_t weight(const Drawing& drawing) { return std::max<std::size_t>(1, drawing.points.size()); }
  static std::size_t weight(const std::vector<Drawing>& shapes);

  std::vector<Set> shown_;                  ///< the shown shapes, sorted by name
  std::vector<std::vector<Drawing>> next_;  ///< the back buffer of each set
  static constexpr std::size_t kAgentBytes = 256;
  std::bitset<kAgentBytes> labelled_;               ///< agents, by their byte in packets, that ever had a text
  std::array<std::uint16_t, kAgentBytes> place_{};  ///< by agent: index of its text in the set, plus 1; 0: none
  std::size_t points_ = 0;                          ///< in all buffers
  std::uint64_t version_ = 0;
};

}  // namespace spark::drawing
