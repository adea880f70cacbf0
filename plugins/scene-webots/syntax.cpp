#include "syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tokens.h"

namespace spark::webots {

namespace {

using Kind = Token::Kind;

constexpr std::string_view kHeader = "#VRML_SIM";
constexpr int kFirstYear = 2022;  ///< since R2022a z is up, and cylinders stand along z

/// Names behind DEF, each of the last node that has it so far.
using Names = std::map<std::string, NodePtr, std::less<>>;

class Parser {
 public:
  explicit Parser(const mjcf::File& file) : file_(file), tokens_(file) {}
  Parsed parse();

 private:
  Error error(const Token& at, const std::string& text) const { return errorAt(file_, at.offset, text); }
  void checkHeader() const;
  std::string word(const char* what);
  void sign(char expected, const std::string& where);
  void readExtern(Parsed& out);
  std::shared_ptr<const Proto> readProto(const Token& keyword);
  void readDeclaration(Proto& proto, Names& names);
  NodePtr readNode(Names& names, int depth);
  std::shared_ptr<const Value> readValue(Names& names, int depth);
  void add(Value& value, Value::Kind kind, const Token& at) const;
  void readItem(Value& value, Names& names, int depth);
  void count(const Token& at, std::size_t& number, std::size_t most, const char* what) const;

  const mjcf::File& file_;
  Tokens tokens_;
  std::size_t nodes_ = 0, fields_ = 0;
};

void Parser::checkHeader() const {
  const std::string_view line = std::string_view(file_.text).substr(0, file_.text.find('\n'));
  const std::size_t at = line.find(kHeader);
  if (at == std::string_view::npos)
    throw errorAt(file_, 0,
                  fmt::format("expected '{} R{}a utf8' or a newer version in the first line", kHeader, kFirstYear));
  const std::size_t version = line.find_first_not_of(' ', at + kHeader.size());
  int year = 0;
  if (version != std::string_view::npos && line[version] == 'R')
    for (std::size_t i = version + 1; i < std::min(version + 5, line.size()) && line[i] >= '0' && line[i] <= '9'; ++i)
      year = 10 * year + (line[i] - '0');
  if (year < kFirstYear)
    throw errorAt(file_, version == std::string_view::npos ? at : version,
                  fmt::format("expected a file of R{}a or newer, in which z is up; found '{}'. What to do: convert it "
                              "with a newer Webots and save it",
                              kFirstYear, version == std::string_view::npos ? "" : line.substr(version, 12)));
}

Parsed Parser::parse() {
  checkHeader();
  Parsed out;
  Names names;
  while (tokens_.peek().kind != Kind::end) {
    const Token first = tokens_.peek();
    if (first.isWord("IMPORTABLE") || first.isWord("EXTERNPROTO"))
      readExtern(out);
    else if (first.isWord("PROTO"))
      out.protos.push_back(readProto(tokens_.next()));
    else
      out.nodes.push_back(readNode(names, 0));
  }
  return out;
}

std::string Parser::word(const char* what) {
  const Token t = tokens_.next();
  if (t.kind != Kind::word) throw error(t, fmt::format("expected {}, found {}", what, t.named()));
  return t.text;
}

void Parser::sign(char expected, const std::string& where) {
  const Token t = tokens_.next();
  if (!t.is(expected)) throw error(t, fmt::format("expected '{}' {}, found {}", expected, where, t.named()));
}

void Parser::count(const Token& at, std::size_t& number, std::size_t most, const char* what) const {
  if (++number > most) throw error(at, fmt::format("expected at most {} {} in a file", most, what));
}

void Parser::readExtern(Parsed& out) {
  if (tokens_.peek().isWord("IMPORTABLE")) tokens_.next();
  const Token keyword = tokens_.next();
  if (!keyword.isWord("EXTERNPROTO")) throw error(keyword, "expected EXTERNPROTO, found " + keyword.named());
  count(keyword, fields_, kMaxFields, "fields");
  const Token url = tokens_.next();
  constexpr std::string_view kEnding = ".proto";
  if (url.kind != Kind::text || !url.text.ends_with(kEnding))
    throw error(url, fmt::format("expected the name of a .proto file in quotes, found {}", url.named()));
  std::string name = url.text.substr(url.text.find_last_of("/\\") + 1);
  name.resize(name.size() - kEnding.size());
  out.externs.push_back({std::move(name), url.text, url.offset});
}

std::shared_ptr<const Proto> Parser::readProto(const Token& keyword) {
  auto proto = std::make_shared<Proto>();
  proto->file = &file_;
  proto->offset = keyword.offset;
  proto->name = word("the name of the PROTO");
  Names names;
  sign('[', "before the fields of the PROTO");
  while (!tokens_.peek().is(']')) readDeclaration(*proto, names);
  tokens_.next();
  sign('{', "before the node of the PROTO");
  proto->body = readNode(names, 1);
  sign('}', "behind the one node of the PROTO");
  return proto;
}

/// field SFColor{0 0 0, 1 1 1} name 0 0 0
void Parser::readDeclaration(Proto& proto, Names& names) {
  static constexpr std::string_view kKeywords[] = {"field",       "vrmlField",       "unconnectedField",
                                                   "hiddenField", "deprecatedField", "w3dField"};
  const Token keyword = tokens_.next();
  if (keyword.kind != Kind::word ||
      std::find(std::begin(kKeywords), std::end(kKeywords), keyword.text) == std::end(kKeywords))
    throw error(keyword,
                fmt::format("expected 'field' or ']' in the PROTO '{}', found {}", proto.name, keyword.named()));
  count(keyword, fields_, kMaxFields, "fields");
  const Token type = tokens_.peek();
  const std::string typeName = word("the type of the field");
  if (!typeName.starts_with("SF") && !typeName.starts_with("MF"))
    throw error(type, fmt::format("expected a type such as SFFloat or MFNode, found {}", type.named()));
  if (tokens_.peek().is('{')) {  // the values that it may have
    int open = 0;
    do {
      const Token t = tokens_.next();
      if (t.kind == Kind::end) throw error(t, "expected a '}' behind the values of the field, found " + t.named());
      open += t.is('{') ? 1 : t.is('}') ? -1 : 0;
    } while (open > 0);
  }
  const std::size_t offset = tokens_.peek().offset;
  std::string name = word("the name of the field");
  proto.fields.push_back({std::move(name), offset, readValue(names, 1)});
}

NodePtr Parser::readNode(Names& names, int depth) {
  const Token first = tokens_.peek();
  if (depth > kMaxDepth) throw error(first, fmt::format("expected nodes nested at most {} deep", kMaxDepth));
  if (first.isWord("USE")) {
    tokens_.next();
    const std::string name = word("a name behind USE");
    const auto found = names.find(name);
    if (found == names.end())
      throw error(first,
                  fmt::format("expected the name of a node that a DEF before this place ends, found '{}'", name));
    return found->second;
  }
  auto node = std::make_shared<Node>();
  if (first.isWord("DEF")) {
    tokens_.next();
    node->definition = word("a name behind DEF");
  }
  node->file = &file_;
  node->offset = tokens_.peek().offset;
  count(tokens_.peek(), nodes_, kMaxNodes, "nodes");
  node->type = word("the type of a node");
  sign('{', fmt::format("behind '{}'", node->type));
  while (!tokens_.peek().is('}')) {
    const Token t = tokens_.peek();
    count(t, fields_, kMaxFields, "fields");
    std::string name = word(fmt::format("a field of {} or '}}'", node->type).c_str());
    const bool hidden = name == "hidden";  // what Webots keeps of a simulation that ran
    if (hidden) name = word("the name of the hidden field");
    auto value = readValue(names, depth + 1);
    if (!hidden) node->fields.push_back({std::move(name), t.offset, std::move(value)});
  }
  tokens_.next();
  if (!node->definition.empty()) names[node->definition] = node;
  return node;
}

std::shared_ptr<const Value> Parser::readValue(Names& names, int depth) {
  auto value = std::make_shared<Value>();
  const Token first = tokens_.peek();
  if (first.isWord("IS")) {
    tokens_.next();
    value->kind = Value::Kind::reference;
    value->texts.push_back(word("the name of a field of the PROTO behind IS"));
  } else if (first.is('[')) {
    tokens_.next();
    while (!tokens_.peek().is(']')) readItem(*value, names, depth);
    tokens_.next();
  } else {
    // Several numbers are one value, such as a vector; other values are alone.
    readItem(*value, names, depth);
    while (value->kind == Value::Kind::numbers && tokens_.peek().kind == Kind::number) readItem(*value, names, depth);
  }
  return value;
}

void Parser::add(Value& value, Value::Kind kind, const Token& at) const {
  if (value.kind != Value::Kind::empty && value.kind != kind)
    throw error(at, fmt::format("expected values of one kind, found {}", at.named()));
  value.kind = kind;
}

void Parser::readItem(Value& value, Names& names, int depth) {
  const Token t = tokens_.peek();
  if (t.kind == Kind::number) {
    add(value, Value::Kind::numbers, t);
    value.numbers.push_back(t.number);
  } else if (t.kind == Kind::text) {
    add(value, Value::Kind::texts, t);
    value.texts.push_back(t.text);
  } else if (t.isWord("TRUE") || t.isWord("FALSE") || t.isWord("NULL")) {
    add(value, Value::Kind::words, t);
    value.texts.push_back(t.text);
  } else if (t.kind == Kind::word) {
    add(value, Value::Kind::nodes, t);
    value.nodes.push_back(readNode(names, depth));
    return;
  } else {
    throw error(t, fmt::format("expected a value, found {}", t.named()));
  }
  tokens_.next();
}

}  // namespace

const Field* Node::field(std::string_view wanted) const {
  const auto found = std::find_if(fields.rbegin(), fields.rend(), [&](const Field& f) { return f.name == wanted; });
  return found == fields.rend() ? nullptr : &*found;
}

std::string_view Node::name() const {
  const Field* const f = field("name");
  return f && f->value->kind == Value::Kind::texts ? std::string_view(f->value->texts.front()) : std::string_view();
}

bool isWebots(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text.starts_with(kHeader);
}

Parsed parsed(const mjcf::File& file) { return Parser(file).parse(); }

Error errorAt(const mjcf::File& file, std::size_t offset, const std::string& text) {
  return Error(fmt::format("{}:{}: {}", file.name, mjcf::lineAndColumn(file.text, offset), text));
}

}  // namespace spark::webots
