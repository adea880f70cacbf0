#pragma once
/// \file
/// Execution of a compiled scene file.

#include <memory>
#include <optional>

#include "environment.h"
#include "rsg_importer.h"
#include "spark/error.h"
#include "spark/node.h"

namespace spark::rsg {

/// Maximum length of the text of a variable or argument [bytes].
inline constexpr std::size_t kMaxText = 4096;

/// Runs the statements of a program: one import of one file.
///
///     (nd Transform            a node is created, added to the tree and linked at once
///       (setLocalPos 0 0 1)    the ten methods of Transform are called at once
///       (importScene x.rsg)    an import, too: the calls that x.rsg queues are made at the end of x.rsg
///       (nd RigidBody
///         (setMass 2)))        all other calls are queued with evaluated arguments, and made at the end of the file
///
/// So a joint may name bodies that come later in its file, and a body is linked below a transform that already has its
/// pose. After an error no further statements run; the queued calls are still made, and then the error is thrown.
class Run {
 public:
  /// `importer` and `program` must outlive the run. `arguments` are those of the program's template.
  Run(RsgImporter& importer, const Program& program, std::vector<std::string> arguments);
  /// Creates the nodes below `root`. Throws Error with file:line:column.
  void execute(Node& root);

 private:
  /// The current node of a list.
  struct Cursor {
    Ref<Leaf> node;
    std::size_t* nextChild;  ///< delta scenes: index of the child that the next nd selects
  };
  /// A call that is made at the end of the file.
  struct Queued {
    Ref<Leaf> node;
    const Statement* call;
    List computed;  ///< its arguments, unless they are constant
  };
  /// Runs the statements of a list, with the current node of the surrounding list at first.
  void runBlock(const Block& block, Cursor cursor);
  /// Runs a statement. When it enters a node, `cursor` refers to that node and to `nextChild`.
  void runStatement(const Statement& s, Cursor& cursor, std::size_t& nextChild);
  Leaf& makeNode(const Statement& s, Leaf& parent);
  ClassObject& classOf(const Statement& s) const;
  Node& nextNode(Cursor& cursor);
  Node& select(const Statement& s, Leaf& parent);
  void choose(const Statement& s, const Cursor& cursor);
  /// Evaluates the arguments of a call, and makes or queues it.
  void call(const Statement& s, Leaf& node);
  void import(const Statement& s, Leaf& node, const List& arguments);
  /// Makes a call, or sets a property.
  void invoke(const Statement& s, Leaf& node, const List& arguments);
  void set(const Statement& s, Leaf& node, const List& arguments);
  void attachScript(Leaf& node, const List& arguments);
  void attachScript(Leaf& node, const std::string& file, const Value& argument);
  /// The resource that an import, or a script, of the name `file` means: the one beside this file goes before the one
  /// from the root.
  std::string resourceOf(const std::string& file) const;
  /// Before a call of a method: what it may change or remove is older than the import or can be undone.
  void beforeCall(const Statement& s, Leaf& node);
  /// The method that a call refers to; nullptr when the node's class has none of that name.
  const Method* methodOf(const Statement& s, Leaf& node) const;
  /// Makes the queued calls.
  void flush();
  /// Evaluates an operand. Throws Error with file:line:column.
  std::string textOf(const Operand& o);
  Value variable(std::string_view group, std::string_view member) const;
  /// Reports a problem that the installed base ignores: throws Error when `strict`, else logs it once per statement.
  void complain(const Statement& s, Level level, const std::string& text);
  /// True when problems that the installed base ignores are errors.
  bool strict() const { return importer_.rules_.strict || program_.ours; }
  /// Calls `f` and prefixes the message of an exception with file:line:column, unless it already has a location of this
  /// run.
  template <class F>
  decltype(auto) located(const Site& site, F f) const;

  RsgImporter& importer_;
  ISceneServer* scenes_;  ///< nullptr: there is none
  const Program& program_;
  Environment environment_;
  Leaf* root_ = nullptr;  ///< the node that the file is imported into
  std::vector<Queued> queue_;
  std::optional<Error> importFailure_;  ///< the first import that failed, while the rest goes on
};

}  // namespace spark::rsg
