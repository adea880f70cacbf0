#pragma once
/// \file
/// Templates: texts with statements of a program between their parts, which writes the text of a PROTO's node.

#include <optional>
#include <string>
#include <vector>

#include "robot/document.h"

namespace spark::webots {

enum class Language { javascript, lua };

/// The text that a template has written, or the text of a file. Its places are those of the file.
struct Expansion {
  /// From `begin` in the text on: what is at `offset` of the file. `runs`: the text is that of the file from there on.
  struct Part {
    std::size_t begin = 0, offset = 0;
    bool runs = true;
  };
  std::string text;
  std::vector<Part> parts;  ///< in order of `begin`
  /// The place in the file of a place in the text.
  std::size_t offsetOf(std::size_t at) const;
};

/// The body of a PROTO that is a template.
struct Template {
  /// What its program writes by a number: a text of the file, or the value of an expression that begins there.
  struct Piece {
    std::size_t offset = 0, size = 0;
    bool isValue = false;
  };
  Language language = Language::javascript;
  /// Calls spark$write(NUMBER) or spark$write(NUMBER, value), with _ in place of $ in Lua, for each piece that it
  /// writes.
  std::string program;
  std::vector<std::size_t> lines;  ///< for each line of the program, where it begins in the file
  std::vector<Piece> pieces;

  /// Adds the piece of a number to what the program has written. False where there is no such piece.
  bool add(Expansion& out, const mjcf::File& file, std::size_t piece, const std::string& value) const;
};

/// Cuts the text of a file from `begin` to `end`, the body of a PROTO, into statements, `%< >%` in Javascript or
/// `%{ }%` in Lua, and the texts between them. nullopt if it has no statement before the } that closes it; the braces
/// of templates need not match. The header of the file names the language as "template language: javascript"; otherwise
/// it is that of the first statement. Throws Error with file:line:column for a statement without an end.
std::optional<Template> templateIn(const mjcf::File& file, std::size_t begin, std::size_t end);

}  // namespace spark::webots
