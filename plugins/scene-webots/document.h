#pragma once
/// \file
/// A Webots file with the PROTOs that it uses in place of their names.

#include <functional>
#include <map>
#include <set>

#include "syntax.h"

namespace spark::webots {

/// The text of a file by its name; nullopt where there is none. Throws Error for a file that cannot be read.
using ReadFile = std::function<std::optional<std::string>(const std::string& name)>;

/// A world, or a PROTO file, with all that it needs of other files.
class Document {
 public:
  /// Largest number of files, of nodes after all PROTOs are in their places, and nesting of these.
  static constexpr std::size_t kMaxFiles = 200, kMaxExpanded = 200'000;
  static constexpr int kMaxNesting = 400;

  /// Reads all files. A PROTO file is one node, with the defaults of its fields. Throws Error with file:line:column.
  Document(const std::string& name, const ReadFile& read, mjcf::Unsupported& unsupported);
  /// The nodes of the file, without PROTOs except for those that are not there. Valid as long as this.
  const std::vector<NodePtr>& nodes() const { return nodes_; }
  /// Why the PROTO of a node's type is not there: "looked for a.proto, b.proto".
  std::string whyMissing(const std::string& type) const;

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
  Found findIn(const std::string& type, const std::vector<std::string>& names);
  NodePtr expand(const NodePtr& node, const Scope& scope);
  NodePtr expandOnce(const Node& node, const Scope& scope);
  std::shared_ptr<const Value> expand(const Field& field, const Node& node, const Scope& scope);
  NodePtr instance(const Node& node, const Found& found, const Scope& scope);

  const ReadFile& read_;
  mjcf::Unsupported& unsupported_;
  std::map<std::string, std::unique_ptr<Source>, std::less<>> sources_;  ///< by file name; nullptr: there is none
  std::map<std::string, std::string, std::less<>> missing_;              ///< why, by type
  std::set<std::string, std::less<>> open_;                              ///< PROTOs that are being expanded
  std::size_t expanded_ = 0;
  std::vector<NodePtr> nodes_;
};

/// Names that a file `url` that is named in the file `of` may have in the file system, the likeliest first. `url`:
/// relative, `webots://projects/...`, or the address of such a file in the web, which is never fetched.
std::vector<std::string> fileNames(std::string_view of, std::string_view url);

}  // namespace spark::webots
