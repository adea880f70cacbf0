#pragma once

#include <array>
#include <bitset>
#include <vector>

#include "api/drawing.h"

namespace spark::drawing {

/// What is drawn, by sets. A set has two pictures: the one that is shown and the next, which is drawn meanwhile;
/// swapping shows the next one and begins a new one. Agents' texts are a set of their own, shown at once.
///
/// Anybody may draw, so what there can be is limited; what does not fit is refused.
class DrawBoard {
 public:
  using Set = IDrawings::Set;
  static constexpr std::size_t kMostSets = 256;
  static constexpr std::size_t kMostShapes = 1024;        ///< of one picture
  static constexpr std::size_t kMostPoints = 8192;        ///< of all pictures, and a shape without any counts as one
  static constexpr std::size_t kMostRecorded = 1u << 20;  ///< bytes that record() appends
  /// Name of the set of agents' texts. Nobody else's shapes go there.
  static constexpr const char* kAgents = "agents";

  std::uint64_t version() const { return version_; }
  /// As IDrawings::sets().
  std::span<const Set> sets() const { return shown_; }

  /// Draws into the next picture of a set. False when there is no room.
  bool add(std::string_view set, Drawing drawing);
  /// Shows the next pictures of all sets whose names begin so.
  void swap(std::string_view prefix);
  /// Shows these shapes in a set, at once. Returns how many found no room.
  std::size_t show(std::string_view set, std::vector<Drawing> shapes);
  /// Sets, or with an empty text takes away, the text of an agent.
  void setAgentText(const Drawing& text);
  /// Shows nothing any more.
  void clear();
  /// As IDrawings::record().
  void record(std::uint64_t since, std::string& out) const;

 private:
  /// Index of a set, made when there is none; the end when there is no room.
  std::size_t indexOf(std::string_view set);
  bool makeRoom();
  void replace(std::size_t i, std::vector<Drawing> shapes);
  static std::size_t weight(const Drawing& drawing) { return std::max<std::size_t>(1, drawing.points.size()); }
  static std::size_t weight(const std::vector<Drawing>& shapes);

  std::vector<Set> shown_;                  ///< by name
  std::vector<std::vector<Drawing>> next_;  ///< of each set
  static constexpr std::size_t kAgentBytes = 256;
  std::bitset<kAgentBytes> labelled_;               ///< agents, by their byte, that ever had a text
  std::array<std::uint16_t, kAgentBytes> place_{};  ///< of an agent's text in their set, from 1; 0: it has none
  std::size_t points_ = 0;
  std::uint64_t version_ = 0;
};

}  // namespace spark::drawing
