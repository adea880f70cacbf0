#pragma once
/// \file
/// The importer of the scene language.

#include <map>

#include "api/files.h"
#include "api/scene.h"
#include "program.h"

namespace spark {

namespace rsg {
class Run;

/// Compatibility switches (scene-language section 8).
struct Rules {
  bool strict = false;             ///< problems that are otherwise logged are errors
  bool evalDigits6 = true;         ///< every eval rounds to single precision and six significant digits
  bool integerDivision = false;    ///< the quotient of two integers is rounded down
  bool looseImports = false;       ///< imports within a file that fail are logged
  bool looseArguments = true;      ///< calls with wrong arguments are skipped with a warning
  bool defineByName = true;        ///< false: definitions and parameters share one list (see Environment)
  bool looseTrailingParen = true;  ///< text after the body is ignored
};

/// Limits of an outermost import with all files that it imports, and what it has used.
struct Budget {
  int maxDepth = 32;                ///< nesting of imports
  std::int64_t maxImports = 10000;  ///< imported files
  std::int64_t maxNodes = 200000;   ///< created nodes
  std::int64_t imports = 0, nodes = 0;
  bool exhausted = false;  ///< a limit was exceeded: ends the outer files, too
};

/// An element of the stack of current imports.
struct Frame {
  const Program* program;
  Site site;  ///< the statement that runs
};
}  // namespace rsg

/// Creates nodes from scene files (`(RSG 0 1)(...)`). Compiled files are cached.
///
/// When a file fails at some statement, the nodes that were created stay, the queued calls are made, and then the error
/// is thrown. When an import within a file fails, the outer file continues, and its error is thrown at the end;
/// `looseImports` logs it instead, `strict` ends the file at once. See README.md.
class RsgImporter : public Leaf, public ISceneImporter {
  SPARK_CLASS(RsgImporter, Leaf)
 public:
  static void describe(Description<RsgImporter>& d);

  bool recognises(std::string_view text, std::string_view file) const override {
    return rsg::looksLikeScene(text) || file.ends_with(".rsg");
  }
  void import(std::string_view file, Node& root, const List& arguments) override;
  bool transactional(std::string_view text) const override { return rsg::isOurs(text); }
  bool keepsTransforms(std::string_view text) const override { return rsg::isOurs(text); }

 private:
  friend class rsg::Run;
  /// A compiled file.
  struct Cached {
    std::uint64_t stamp;   ///< of the file when it was compiled
    std::int64_t checked;  ///< number of the last outermost import that compared the stamp
    std::int64_t bytes;    ///< length of the text
    std::shared_ptr<const rsg::Program> program;
  };
  /// The compiled form of a file, from the cache where it is up to date. Throws Error.
  std::shared_ptr<const rsg::Program> load(const std::string& file, Node& root);
  /// Adds to the cache, and removes the least recently used files beyond `keptBytes`.
  void keep(const std::string& file, Cached cached);
  void clearCache() {
    cache_.clear();
    kept_ = 0;
  }
  /// The arguments of an import as texts. Throws Error for lists and nil, for texts that are too long, and, from
  /// outside, for numbers that are too large.
  std::vector<std::string> textsOf(std::string_view file, const List& arguments) const;
  /// " (imported from a:1:2, from b:3:4)" for the imports around the current one; "" without any.
  std::string chain() const;
  /// Throws Error for an exceeded limit.
  [[noreturn]] void exhausted(const std::string& message);
  template <bool rsg::Rules::*Member>
  bool rule() const {
    return rules_.*Member;
  }
  template <bool rsg::Rules::*Member>
  void setRule(bool on) {
    rules_.*Member = on;
    clearCache();  // some rules affect compilation
  }
  int maxDepth() const { return budget_.maxDepth; }
  void setMaxDepth(int n) { budget_.maxDepth = n; }
  std::int64_t maxImports() const { return budget_.maxImports; }
  void setMaxImports(std::int64_t n) { budget_.maxImports = n; }
  std::int64_t maxNodes() const { return budget_.maxNodes; }
  void setMaxNodes(std::int64_t n) { budget_.maxNodes = n; }

  rsg::Rules rules_;
  rsg::Budget budget_;
  double argumentLimit_ = 1e9;
  bool unlinkOnCompleteScenes_ = false, unlinkOnUnreadable_ = false;
  std::int64_t keptBytes_ = 16 << 20;  ///< limit of kept_
  std::int64_t kept_ = 0;              ///< total length of the texts in the cache
  std::int64_t filesParsed_ = 0, imports_ = 0, evals_ = 0, calls_ = 0;
  std::int64_t outermost_ = 0;                        ///< number of outermost imports so far
  std::map<std::string, Cached, std::less<>> cache_;  ///< by file
  std::vector<rsg::Frame> frames_;                    ///< current imports, the innermost last
};

}  // namespace spark
