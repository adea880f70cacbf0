#pragma once
/// \file
/// The elements and attributes of URDF that mean something here.

#include <span>

#include "elements.h"
#include "robot/word.h"

namespace spark::urdf {

using mjcf::Word;

/// All words, where "robot/link" is a link in a robot: what is not among them is not supported. The README has the same
/// table.
std::span<const Word> vocabulary();

/// Names every element and attribute of a robot, and every text, that no word allows, and what is there twice where the
/// first one alone counts.
void nameUnknown(const Element& root, Unsupported& unsupported);

}  // namespace spark::urdf
