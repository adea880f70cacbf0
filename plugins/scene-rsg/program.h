#pragma once
/// \file
/// The compiled form of a scene file, which the importer runs for every robot of a kind without parsing again.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "spark/class_object.h"

namespace spark::rsg {

/// Line and column in a file, from 1.
struct Site {
  std::uint32_t line = 0, column = 0;
};

/// An argument: a text, a variable, `(eval ...)` or `(join ...)`. A malformed one is an error when it is evaluated.
struct Operand {
  enum class Kind { text, variable, eval, join, bad };
  Kind kind = Kind::text;
  std::string text;            ///< text: the text; bad: the error message
  std::size_t slot = 0;        ///< variable: index in Program::variables
  std::vector<Operand> parts;  ///< eval, join: the operands in the list
  Site site;
};

struct Statement;

/// The statements of one list. They run in order and share a current node.
struct Block {
  std::vector<Statement> statements;
};

/// A statement.
struct Statement {
  enum class Kind {
    block,       ///< a nested list: `blocks[0]`
    node,        ///< nd: creates a node of class `text` and makes it the current node
    nextNode,    ///< nd in a delta scene: makes the next child the current node
    select,      ///< sel: makes the child named `text` the current node
    print,       ///< pwd: logs the path of the current node
    parameters,  ///< templ: declares the parameters `slots`
    define,      ///< def: `slots[0]` := `operands[0]`
    choose,      ///< switch: runs `blocks[i]` for the first i where `operands[1 + i]` equals `operands[0]`
    call,        ///< calls the method `text` of the current node with `operands`
    set,         ///< version 0.2: sets the property `text` of the current node to `operands`
    error        ///< throws an Error with the message `text`
  };
  Kind kind = Kind::block;
  bool immediate = false;  ///< call: made at once; all others and set are queued to the end of the file
  std::string text;
  std::vector<std::size_t> slots;
  std::vector<Operand> operands;
  bool constant = false;  ///< call, set: all operands are texts
  List arguments;         ///< call, set, if constant: these texts
  std::vector<Block> blocks;
  Site site;

  // Caches, filled when the statement runs.
  mutable Ref<ClassObject> nodeClass;      ///< node: its class
  mutable std::uint64_t classId = 0;       ///< call: id of the class for which `method` was looked up
  mutable const Method* method = nullptr;  ///< call: the method of that class; nullptr: it has none
  mutable bool complained = false;         ///< a problem of this statement was logged
};

/// A compiled scene file. Immutable except for the caches of its statements.
struct Program {
  std::string resource;                ///< name of the file
  bool delta = false;                  ///< RDS: the file changes existing nodes
  bool ours = false;                   ///< version 0.2: without the leniency of the installed base
  std::vector<std::string> variables;  ///< names by slot, with '$'
  Block body;
};

/// Options of compile().
struct ReadingRules {
  bool looseTrailingParen = true;  ///< text after the body is ignored; false: it is an error
  std::uint32_t maxDepth = 256;    ///< of nested lists
};

/// True when the text begins with the header of a scene file, in any version.
bool looksLikeScene(std::string_view text);
/// True when the text begins with the header of a scene file in version 0.2, which is Spark's own.
bool isOurs(std::string_view text);

/// Compiles the text of the file `resource`. Throws Error with file:line:column when the header or the brackets are
/// wrong. Other errors become statements that fail when they run, as in the installed base.
std::shared_ptr<const Program> compile(std::string_view resource, std::string_view text, const ReadingRules& rules);

/// "file:line:column".
std::string where(const Program& program, const Site& site);

}  // namespace spark::rsg
