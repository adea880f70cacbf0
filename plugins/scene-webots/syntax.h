#pragma once
/// \file
/// The syntax of Webots files, which is that of VRML: nodes of fields, and PROTO declarations.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/document.h"

namespace spark::webots {

struct Node;
using NodePtr = std::shared_ptr<const Node>;

/// What a field has: numbers, texts, words (TRUE, FALSE, NULL) or nodes, all of one kind; or the name of a field of the
/// PROTO around it (IS).
struct Value {
  enum class Kind { empty, numbers, texts, words, nodes, reference };
  Kind kind = Kind::empty;  ///< empty: []
  std::vector<double> numbers{};
  std::vector<std::string> texts{};  ///< texts, words, or the one name
  std::vector<NodePtr> nodes{};
};

struct Field {
  std::string name;
  std::size_t offset = 0;
  std::shared_ptr<const Value> value;
};

/// A node as the file has it. USE is the node that it names.
struct Node {
  std::string type, definition;  ///< `definition`: the name behind DEF; ""
  const mjcf::File* file = nullptr;
  std::size_t offset = 0;
  std::vector<Field> fields{};
  /// nullptr where there is no such field. The last one of that name.
  const Field* field(std::string_view name) const;
  /// The node's own name: its field `name`; "" where there is none.
  std::string_view name() const;
  /// For errors. Valid as long as the node.
  mjcf::Element element() const { return {{}, file, offset, type, name()}; }
};

/// PROTO NAME [ fields ] { node }
struct Proto {
  std::string name;
  const mjcf::File* file = nullptr;
  std::size_t offset = 0;
  std::vector<Field> fields{};  ///< with their defaults
  NodePtr body;
};

/// EXTERNPROTO "URL"
struct Extern {
  std::string name, url;
  std::size_t offset = 0;
};

/// A file and what it consists of.
struct Parsed {
  std::vector<Extern> externs;
  std::vector<std::shared_ptr<const Proto>> protos;
  std::vector<NodePtr> nodes;
};

/// Largest nesting of nodes in a file, and number of nodes and of fields.
inline constexpr int kMaxDepth = 200;
inline constexpr std::size_t kMaxNodes = 200'000, kMaxFields = 2'000'000;

/// True for a text that begins as Webots files do.
bool isWebots(std::string_view text);

/// Reads the text of a file. Throws Error with file:line:column. `file` must outlive the result.
Parsed parsed(const mjcf::File& file);

/// The place in a file and a text, to be thrown.
Error errorAt(const mjcf::File& file, std::size_t offset, const std::string& text);

}  // namespace spark::webots
