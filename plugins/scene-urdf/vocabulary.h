#pragma once
/// \file
/// The elements and attributes of URDF that mean something here.

#include <span>
#include <string_view>

#include "elements.h"

namespace spark::urdf {

/// What an element may have, and in which elements it may be. Lists are words with a blank between them.
struct Word {
  std::string_view element;
  std::string_view in;    ///< the elements around it: "robot/link" is a link in a robot
  std::string_view read;  ///< attributes that are read
  std::string_view idle;  ///< attributes that are no part of a simulation
  enum Content { elements, text, foreign } content = elements;  ///< foreign: its own reader names the rest
  bool repeats = false;                                         ///< there may be several
};

/// All words: what is not among them is not supported. The README has the same table.
std::span<const Word> vocabulary();

/// Names every element and attribute of a robot, and every text, that no word allows, and what is there twice where the
/// first one alone counts.
void nameUnknown(const Element& root, Unsupported& unsupported);

}  // namespace spark::urdf
