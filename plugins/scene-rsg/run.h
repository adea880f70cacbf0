#pragma once
/// \file
/// One import of one file.

#include <memory>

#include "environment.h"
#include "rsg_importer.h"
#include "spark/node.h"

namespace spark::rsg {

/// Longest text that a variable or argument may become.
inline constexpr std::size_t kMaxText = 4096;

/// Walks a program's lists and builds what they say.
///
///     (nd Transform            a node is made, hung in the tree and linked at once
///       (setLocalPos 0 0 1)    Transform's own ten methods act at once
///       (importScene x.rsg)    so does an import: x.rsg's queued calls run at x.rsg's end, before what follows here
///       (nd RigidBody
///         (setMass 2)))        all other calls wait, with their arguments computed, until this file is read
///
/// So a joint may name bodies that come later in its file, and a body finds its transform in place. An error ends the
/// walk; the queued calls run nevertheless, then it is thrown.
class Run {
 public:
  Run(RsgImporter& importer, const Program& program, std::vector<std::string> arguments);
  /// Throws Error with file:line:column.
  void execute(Node& root);

 private:
  /// The current node of a list, and how many of its children a delta scene has passed.
  struct Cursor {
    Ref<Node> node;
    std::size_t* passed;
  };
  struct Queued {
    Ref<Leaf> node;
    const Statement* call;
    List computed;  ///< its arguments, when they are not constant
  };
  void walk(const Block& block, Cursor cursor);
  /// Runs one statement; `passed` counts for the node that it may enter.
  void step(const Statement& s, Cursor& cursor, std::size_t& passed);
  Node& makeNode(const Statement& s, Node& parent);
  ClassObject& classOf(const Statement& s) const;
  Node& nextNode(Cursor& cursor);
  Node& select(const Statement& s, Node& parent);
  void choose(const Statement& s, const Cursor& cursor);
  void call(const Statement& s, Node& node);
  void import(const Statement& s, Node& node, const List& arguments);
  void invoke(const Statement& s, Leaf& node, const List& arguments);
  const Method* methodOf(const Statement& s, Leaf& node) const;
  void flush();
  std::string textOf(const Operand& o);
  Value variable(std::string_view group, std::string_view member) const;
  /// What the installed base passes over: an Error when strict, else a log line, once for each place.
  void complain(const Statement& s, Level level, const std::string& sentence);
  /// Runs `f`; an exception gets file:line:column in front, unless it has one of this run already.
  template <class F>
  decltype(auto) located(const Site& site, F f) const;

  RsgImporter& importer_;
  const Program& program_;
  Environment environment_;
  Leaf* root_ = nullptr;
  std::vector<Queued> queue_;
};

}  // namespace spark::rsg
