#pragma once
/// \file
/// A Webots file with the PROTOs that it uses in place of their names.

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>

#include "syntax.h"

namespace spark::webots {

/// The text of a file by its name; nullopt where there is none. Throws Error for a file that cannot be read.
using ReadFile = std::function<std::optional<std::string>(const std::string& name)>;
/// Runs the program of a template: a request and its answer in JSON (template/request.h). Throws Error.
using RunTemplate = std::function<std::string(const std::string& request)>;

/// Where a document's parts come from.
struct Sources {
  ReadFile read;
  RunTemplate run;                     ///< empty: templates are not there
  std::vector<std::string> folders{};  ///< in which PROTO files are looked for as well
  /// Files with a name of their own ("P.proto") anywhere else, the likeliest first; empty: there are none.
  std::function<std::vector<std::string>(const std::string& name)> called{};
};

/// A world, or a PROTO file, with all that it needs of other files.
class Document {
 public:
  /// Largest number of files and of nodes after all PROTOs are in their places, size of all texts, and nesting of
  /// nodes.
  static constexpr std::size_t kMaxFiles = 5'000, kMaxExpanded = 500'000, kMaxTexts = std::size_t{1} << 30;
  static constexpr int kMaxNesting = 400;

  /// Reads all files. A PROTO file is one node, with the defaults of its fields. Throws Error with file:line:column.
  Document(const std::string& name, const Sources& sources, mjcf::Unsupported& unsupported);
  /// The nodes of the file, without PROTOs except for those that are not there. Valid as long as this.
  const std::vector<NodePtr>& nodes() const { return nodes_; }
  /// Why the PROTO of a node's type is not there: "looked for a.proto, b.proto".
  std::string whyMissing(const std::string& type) const;
  /// How the world's axes lie: that of its WorldInfo, or of its version: "ENU", "NUE", "EUN".
  const std::string& coordinates() const { return coordinates_; }
  /// What templates have printed, with the file: "a.proto: hello".
  const std::vector<std::string>& said() const { return said_; }

 private:
  struct Source {
    mjcf::File file;
    Parsed parsed;
  };
  /// The fields of a PROTO's instance, by name.
  using Arguments = std::map<std::string, std::shared_ptr<const Value>, std::less<>>;
  /// Where a node is: in a file, and in the instance of a PROTO.
  struct Scope {
    const Source& source;
    const Arguments* arguments = nullptr;
    std::map<const Node*, NodePtr>& done;  ///< a node that USE names is one afterwards, too
    int depth = 0;
  };
  struct Found {
    const Source* source = nullptr;
    std::shared_ptr<const Proto> proto;
  };

  const Source* load(const std::string& name);
  Found find(const Node& node, const Source& source);
  Found findKnown(const Node& node);
  Found findElsewhere(const Node& node, bool isNamed);
  Found findIn(const std::string& type, const std::vector<std::string>& names);
  NodePtr expand(const NodePtr& node, const Scope& scope);
  NodePtr expandOnce(const Node& node, const Scope& scope);
  std::shared_ptr<const Value> expand(const Field& field, const Node& node, const Scope& scope);
  NodePtr instance(const Node& node, const Found& found, const Scope& scope);
  NodePtr body(const Found& found, const Arguments& arguments, const Scope& scope);
  const Parsed& run(const Proto& proto, const nlohmann::json& fields);
  static Error failure(const Proto& proto, std::string what);
  static std::string coordinatesOf(const Parsed& parsed);
  void name(const std::vector<Problem>& problems, const mjcf::File& file);
  void missing(const std::string& type, std::string why);

  const Sources& from_;
  mjcf::Unsupported& unsupported_;
  std::map<std::string, std::unique_ptr<Source>, std::less<>> sources_;  ///< by file name; nullptr: there is none
  std::map<std::string, std::string, std::less<>> missing_;              ///< why, by type
  std::set<std::string, std::less<>> open_;                              ///< PROTOs that are being expanded
  std::map<std::string, Parsed, std::less<>> written_;                   ///< what templates wrote, by request
  std::vector<std::string> said_;
  std::string main_, coordinates_;
  std::size_t expanded_ = 0, files_ = 0, texts_ = 0;
  std::vector<NodePtr> nodes_;
};

/// Names that a file `url` that is named in the file `of` may have in the file system, the likeliest first. `url`:
/// relative, `webots://projects/...`, or the address of such a file in the web, which is never fetched.
/// `folders`: in which a file may be as well.
std::vector<std::string> fileNames(std::string_view of, std::string_view url,
                                   const std::vector<std::string>& folders = {});

}  // namespace spark::webots
