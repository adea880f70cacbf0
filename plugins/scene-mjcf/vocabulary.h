#pragma once
/// \file
/// The elements and attributes of MJCF that the importer knows.

#include <span>
#include <string_view>

#include "robot/document.h"

namespace spark::mjcf {

/// What an element may have, and in which elements it may be. Lists are words with a blank between them.
struct Word {
  std::string_view element;
  std::string_view in;    ///< the elements around it
  std::string_view read;  ///< attributes that are read, or named where their values are not supported
  std::string_view idle;  ///< attributes that are no part of a simulation
  enum Content {
    elements,
    foreign  ///< its reader names what it does not take, or all of it is named
  } content = elements;
};

/// All words: what is not among them is not supported. The README has the same table.
std::span<const Word> vocabulary();

/// Names every element and attribute of a document that no word allows, in defaults and in what is no part of a
/// simulation, too.
void nameUnknown(Document& document, Unsupported& unsupported);

}  // namespace spark::mjcf
