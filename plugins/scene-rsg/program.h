#pragma once
/// \file
/// The compiled form of a scene file: what the importer runs, for every robot of a kind, without reading text again.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/class_object.h"

namespace spark::rsg {

/// Where something stands in its file, from 1.
struct Site {
  std::uint32_t line = 0, column = 0;
};

/// An argument: a text, a variable, `(eval ...)`, `(join ...)`; or what can be none of them, an error once it is
/// reached.
struct Operand {
  enum class Kind { text, variable, eval, join, bad };
  Kind kind = Kind::text;
  std::string text;            ///< the text; bad: the sentence
  int slot = 0;                ///< variable: its number in the file
  std::vector<Operand> parts;  ///< eval, join
  Site site;
};

struct Statement;

/// The elements of one list, run in order with a current node of their own.
struct Block {
  std::vector<Statement> statements;
};

/// One step of a list.
struct Statement {
  enum class Kind {
    block,       ///< a list in the list
    node,        ///< nd: make `text`, go on in it
    nextNode,    ///< nd of a delta scene: go on in the next child
    select,      ///< sel: go on in the child `text`
    print,       ///< pwd
    parameters,  ///< templ: `slots`
    define,      ///< def: `slots[0]` := `operands[0]`
    choose,      ///< switch: `operands[0]` against `operands[1 + i]`, then `blocks[i]`
    call,        ///< method `text` with `operands`
    error        ///< `text` is wrong with the file; ends it once it is reached
  };
  Kind kind = Kind::block;
  bool immediate = false;  ///< call: done while the file is read, not at its end
  std::string text;
  std::vector<int> slots;
  std::vector<Operand> operands;
  bool constant = false;  ///< call: all operands are texts,
  List arguments;         ///< these
  std::vector<Block> blocks;
  Site site;

  // What the last run found out. node: its class.
  mutable Ref<ClassObject> made;
  // call: its method; a class is told by its number, which is never used again.
  mutable std::uint64_t classId = 0;
  mutable const Method* method = nullptr;
  mutable bool complained = false;
};

/// A scene file.
struct Program {
  std::string resource;
  bool delta = false;                  ///< RDS: changes of what is there
  std::vector<std::string> variables;  ///< by slot, with '$'
  Block body;
};

/// Limits of what is read.
struct ReadingRules {
  bool looseTrailingParen = true;  ///< what follows the body is ignored
  std::uint32_t maxDepth = 256;
};

/// True when the text begins with the header of a scene file, of whatever version.
bool looksLikeScene(std::string_view text);

/// Compiles a file. Throws Error with file:line:column when it cannot be read at all: header, brackets. What is wrong
/// inside becomes a statement that fails when it is reached, as the installed base has it.
std::shared_ptr<const Program> compile(std::string_view resource, std::string_view text, const ReadingRules& rules);

/// "file:line:column".
std::string where(const Program& program, const Site& site);

}  // namespace spark::rsg
