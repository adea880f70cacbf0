#pragma once
/// \file
/// Names of percepts as they were before 2007: Flag, Goal, Ball, Player in place of F1L, G1L, B, P.

#include <cctype>
#include <string>
#include <string_view>

#include "spark/predicates.h"

namespace spark::soccer {

/// True for the labels of flags and goal posts: F1L, G2R.
inline bool isFlagOrGoal(std::string_view label) {
  return label.size() == 3 && (label[0] == 'F' || label[0] == 'G') && (label[2] == 'L' || label[2] == 'R');
}

/// Opens the list of an object that is seen: (F1L, or with long names (Flag (id 1_l).
inline Predicates& openSeen(Predicates& out, std::string_view label, bool longNames) {
  if (!longNames) return out.open(label);
  if (isFlagOrGoal(label)) {
    const char id[] = {label[1], '_', static_cast<char>(std::tolower(label[2])), 0};
    out.open(label[0] == 'F' ? "Flag" : "Goal").pair("id", std::string_view(id));
    return out;
  }
  return out.open(label == "B" ? "Ball" : label == "P" ? "Player" : label);
}

/// The label of an object in a percept with either kind of names.
inline std::string labelOf(const Element& seen) {
  const std::string_view head = seen.head();
  if (head == "Ball") return "B";
  if (head == "Player") return "P";
  const Element id = head == "Flag" || head == "Goal" ? seen.named("id") : Element();
  const std::string_view text = id ? id.at(1).text() : std::string_view();
  if (text.size() != 3) return std::string(head);
  return {head.front(), text.front(), static_cast<char>(std::toupper(text.back()))};
}

}  // namespace spark::soccer
