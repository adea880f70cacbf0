#pragma once
/// \file
/// The elements and attributes of MJCF that the importer knows.

#include <span>

#include "robot/document.h"
#include "robot/word.h"

namespace spark::mjcf {

/// All words: what is not among them is not supported. The README has the same table.
std::span<const Word> vocabulary();

/// Names every element and attribute of a document that no word allows, in defaults and in what is no part of a
/// simulation, too.
void nameUnknown(Document& document, Unsupported& unsupported);

}  // namespace spark::mjcf
