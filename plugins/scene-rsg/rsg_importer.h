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

/// Compatibility switches (scene-language section 8), with the defaults of the installed base.
struct Rules {
  bool strict = false;             ///< whatever is only logged below is an error
  bool evalDigits6 = true;         ///< every eval rounds to six significant digits
  bool integerDivision = false;    ///< two integers divide to the floor
  bool looseArguments = true;      ///< calls with wrong arguments are skipped with a warning
  bool defineByName = true;        ///< false: definitions and parameters share one list
  bool looseTrailingParen = true;  ///< what follows the body is ignored
};

/// How much one import from outside may do.
struct Budget {
  int maxDepth = 32;  ///< imports within imports
  std::int64_t maxImports = 10000, maxNodes = 200000;
  std::int64_t imports = 0, nodes = 0;
  bool exhausted = false;  ///< ends all files under way
};

/// An import under way: which file, and where it stands.
struct Frame {
  const Program* program;
  Site site;
};
}  // namespace rsg

/// Builds nodes from scene files (`(RSG 0 1)(...)`), from a compiled form that is kept for each file.
///
/// A file that is wrong inside keeps the nodes made so far, runs the calls queued so far, and then throws. An import
/// within a file that fails is logged, and the outer file goes on (unless `strict`). See README.md.
class RsgImporter : public Leaf, public ISceneImporter {
  SPARK_CLASS(RsgImporter, Leaf)
 public:
  static void describe(Description<RsgImporter>& d);

  bool recognises(std::string_view text) const override { return rsg::looksLikeScene(text); }
  void import(std::string_view file, Node& root, const List& arguments) override;

 private:
  friend class rsg::Run;
  struct Cached {
    std::uint64_t stamp;
    std::int64_t checked;  ///< the outermost import in which the stamp was looked at
    std::int64_t bytes;    ///< of the text
    std::shared_ptr<const rsg::Program> program;
  };
  std::shared_ptr<const rsg::Program> load(const std::string& file, Node& root);
  void keep(const std::string& file, Cached cached);
  void forget() {
    cache_.clear();
    kept_ = 0;
  }
  std::vector<std::string> textsOf(std::string_view file, const List& arguments) const;
  /// " (imported from a:1:2, from b:3:4)" for the frames above the innermost.
  std::string chain() const;
  /// Throws for an import that did too much.
  [[noreturn]] void exhausted(const std::string& sentence);
  template <bool rsg::Rules::*Member>
  bool rule() const {
    return rules_.*Member;
  }
  template <bool rsg::Rules::*Member>
  void setRule(bool on) {
    rules_.*Member = on;
    forget();  // some rules are about reading
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
  std::int64_t keptBytes_ = 16 << 20, kept_ = 0;
  std::int64_t filesParsed_ = 0, imports_ = 0, evals_ = 0, calls_ = 0, outermost_ = 0;
  std::map<std::string, Cached, std::less<>> cache_;
  std::vector<rsg::Frame> frames_;
};

}  // namespace spark
