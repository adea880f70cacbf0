#pragma once
/// \file
/// The syntax of Webots files, which is that of VRML: nodes of fields, and PROTO declarations.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/document.h"
#include "template_text.h"

namespace spark::webots {

struct Node;
using NodePtr = std::shared_ptr<const Node>;

/// What a field has: numbers, texts, words (TRUE, FALSE, NULL) or nodes, all of one kind; or the name of a field of the
/// PROTO around it (IS).
struct Value {
  enum class Kind { empty, numbers, texts, words, nodes, reference };
  Kind kind = Kind::empty;  ///< empty: []
  bool isList = false;      ///< between [ and ]
  std::vector<double> numbers{};
  std::vector<std::string> texts{};  ///< texts, words, or the one name
  std::vector<NodePtr> nodes{};
};

struct Field {
  std::string name;
  std::size_t offset = 0;
  std::shared_ptr<const Value> value;
  std::string type{};  ///< "SFVec3f"; "" for that of a node
};

/// A node as the file has it. USE is the node that it names.
struct Node {
  std::string type, definition;  ///< `definition`: the name behind DEF; ""
  const mjcf::File* file = nullptr;
  std::size_t offset = 0;
  std::vector<Field> fields{};
  bool yUp = false;  ///< of a file before R2022a, in which cylinders, capsules and planes stand along y
  NodePtr origin{};  ///< the instance of a PROTO that it is, nullptr if it is none
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
  NodePtr body{};               ///< nullptr for a template
  std::optional<Template> text{};
};

/// EXTERNPROTO "URL"
struct Extern {
  std::string name, url;
  std::size_t offset = 0;
};

/// A part of a file that is left out, and why.
struct Problem {
  std::size_t offset = 0;
  std::string text;
};

/// A file and what it consists of.
struct Parsed {
  bool yUp = false;  ///< before R2022a y was up
  std::vector<Extern> externs;
  std::vector<std::shared_ptr<const Proto>> protos;
  std::vector<NodePtr> nodes;
  std::vector<Problem> problems;
};

/// What Webots keeps of a simulation that ran, in fields that begin so.
inline constexpr std::string_view kHidden = "hidden ";
inline constexpr const char* kHiddenIgnored = "hidden fields, the state of a simulation that ran, are not supported";

/// Largest nesting of nodes in a file, and number of nodes and of fields.
inline constexpr int kMaxDepth = 200;
inline constexpr std::size_t kMaxNodes = 200'000, kMaxFields = 2'000'000;

/// True for a text that begins as Webots files do.
bool isWebots(std::string_view text);

/// Reads the text of a file. Throws Error with file:line:column. `file` must outlive the result.
Parsed parsed(const mjcf::File& file);

/// Reads the one node that a template of the file has written. Throws Error with the place in the file.
Parsed parsedNode(const mjcf::File& file, const Expansion& expansion);

/// The place in a file and a text, to be thrown.
Error errorAt(const mjcf::File& file, std::size_t offset, const std::string& text);

}  // namespace spark::webots
