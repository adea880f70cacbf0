#include "syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tokens.h"

namespace spark::webots {

namespace {

using Kind = Token::Kind;

constexpr std::string_view kHeader = "#VRML_SIM", kProtoEnding = ".proto";
constexpr int kFirstYear = 2022;  ///< since R2022a z is up, and cylinders stand along z

/// Names behind DEF, each of the last node that has it so far.
using Names = std::map<std::string, NodePtr, std::less<>>;

/// What programs print for numbers that are none.
bool isNoNumber(const Token& t) {
  return t.isWord("nan") || t.isWord("-nan") || t.isWord("inf") || t.isWord("-inf") || t.isWord("NaN");
}

class Parser {
 public:
  explicit Parser(const mjcf::File& file) : file_(file), tokens_(file) {}
  Parser(const mjcf::File& file, const Expansion& expansion) : file_(file), tokens_(file, expansion) {}
  Parsed parse();
  Parsed parseNode();

 private:
  Error error(const Token& at, const std::string& text) const { return errorAt(file_, at.offset, text); }
  void readHeader(bool isProto);
  std::string word(const char* what);
  void sign(char expected, const std::string& where);
  void readExtern(Parsed& out);
  std::shared_ptr<const Proto> readProto(const Token& keyword);
  bool readTemplate(Proto& proto, std::size_t begin);
  void readDeclaration(Proto& proto, Names& names);
  NodePtr readNode(Names& names, int depth);
  std::shared_ptr<const Value> readValue(Names& names, int depth);
  void add(Value& value, Value::Kind kind, const Token& at) const;
  void readItem(Value& value, Names& names, int depth);
  void count(const Token& at, std::size_t& number, std::size_t most, const char* what) const;

  const mjcf::File& file_;
  Tokens tokens_;
  std::size_t nodes_ = 0, fields_ = 0;
  std::vector<Problem> problems_;
  bool yUp_ = false;
};

/// "#VRML_SIM R2023b utf8", or "#VRML_SIM V8.5 utf8" before 2018.
void Parser::readHeader(bool isProto) {
  const std::string_view line = std::string_view(file_.text).substr(0, file_.text.find('\n'));
  const std::size_t at = line.find(kHeader);
  if (at == std::string_view::npos) {
    const std::string expected =
        fmt::format("expected '{} R{}a utf8', or another version, in the first line", kHeader, kFirstYear);
    if (!isProto) throw errorAt(file_, 0, expected);
    // The oldest PROTO files have none.
    problems_.push_back({0, fmt::format("{}; it is read as a file before R{}a", expected, kFirstYear)});
    yUp_ = true;
    return;
  }
  const std::size_t version = line.find_first_not_of(' ', at + kHeader.size());
  int year = 0;
  if (version != std::string_view::npos && line[version] == 'R')
    for (std::size_t i = version + 1; i < std::min(version + 5, line.size()) && line[i] >= '0' && line[i] <= '9'; ++i)
      year = 10 * year + (line[i] - '0');
  yUp_ = year < kFirstYear;
}

Parsed Parser::parse() {
  const Token begin = tokens_.peek();
  readHeader(begin.isWord("PROTO") || begin.isWord("EXTERNPROTO"));
  Parsed out;
  out.yUp = yUp_;
  Names names;
  while (tokens_.peek().kind != Kind::end) {
    const Token first = tokens_.peek();
    if (first.isWord("IMPORTABLE") || first.isWord("EXTERNPROTO"))
      readExtern(out);
    else if (first.isWord("PROTO"))
      out.protos.push_back(readProto(tokens_.next()));
    else if (NodePtr node = readNode(names, 0))
      out.nodes.push_back(std::move(node));
  }
  out.problems = std::move(problems_);
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
  if (url.kind != Kind::text)
    throw error(url, fmt::format("expected the name of a .proto file in quotes, found {}", url.named()));
  if (!url.text.ends_with(kProtoEnding)) {
    problems_.push_back(
        {url.offset, fmt::format("expected the name of a .proto file, found {}; it is ignored", url.named())});
    return;
  }
  std::string name = url.text.substr(url.text.find_last_of("/\\") + 1);
  name.resize(name.size() - kProtoEnding.size());
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
  if (tokens_.peek().is('{') && readTemplate(*proto, tokens_.peek().offset + 1)) return proto;
  sign('{', "before the node of the PROTO");
  proto->body = readNode(names, 1);
  sign('}', "behind the one node of the PROTO");
  return proto;
}

/// False where the node is no template. A template ends with the file, since the braces of its texts need not match.
bool Parser::readTemplate(Proto& proto, std::size_t begin) {
  const std::size_t end = file_.text.rfind('}');
  if (end == std::string::npos || end < begin) return false;
  proto.text = templateIn(file_, begin, end);
  if (proto.text) tokens_.skipTo(end + 1);
  return proto.text.has_value();
}

Parsed Parser::parseNode() {
  readHeader(true);
  Names names;
  Parsed out;
  if (NodePtr node = readNode(names, 1)) out.nodes.push_back(std::move(node));
  if (tokens_.peek().kind != Kind::end)
    throw error(tokens_.peek(), "expected one node in the PROTO, found " + tokens_.peek().named() + " behind it");
  out.problems = std::move(problems_);
  return out;
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
  proto.fields.push_back({std::move(name), offset, readValue(names, 1), typeName});
}

/// nullptr for a USE of a node that is not there.
NodePtr Parser::readNode(Names& names, int depth) {
  const Token first = tokens_.peek();
  if (depth > kMaxDepth) throw error(first, fmt::format("expected nodes nested at most {} deep", kMaxDepth));
  if (first.isWord("USE")) {
    tokens_.next();
    const std::string name = word("a name behind USE");
    const auto found = names.find(name);
    if (found != names.end()) return found->second;
    problems_.push_back(
        {first.offset,
         fmt::format("expected the name of a node that a DEF before this place ends, found '{}'; it is left out",
                     name)});
    return nullptr;
  }
  auto node = std::make_shared<Node>();
  if (first.isWord("DEF")) {
    tokens_.next();
    node->definition = word("a name behind DEF");
  }
  node->file = &file_;
  node->yUp = yUp_;
  node->offset = tokens_.peek().offset;
  count(tokens_.peek(), nodes_, kMaxNodes, "nodes");
  node->type = word("the type of a node");
  sign('{', fmt::format("behind '{}'", node->type));
  while (!tokens_.peek().is('}')) {
    const Token t = tokens_.peek();
    count(t, fields_, kMaxFields, "fields");
    std::string name = word(fmt::format("a field of {} or '}}'", node->type).c_str());
    if (name == "hidden") name = std::string(kHidden) + word("the name of the hidden field");
    node->fields.push_back({std::move(name), t.offset, readValue(names, depth + 1)});
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
    value->isList = true;
    while (!tokens_.peek().is(']')) readItem(*value, names, depth);
    tokens_.next();
  } else {
    // Several numbers are one value, such as a vector; other values are alone.
    readItem(*value, names, depth);
    while (value->kind == Value::Kind::numbers && (tokens_.peek().kind == Kind::number || isNoNumber(tokens_.peek())))
      readItem(*value, names, depth);
  }
  if (value->kind == Value::Kind::nodes && value->nodes.empty()) value->kind = Value::Kind::empty;
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
  } else if (isNoNumber(t)) {
    add(value, Value::Kind::numbers, t);
    value.numbers.push_back(0);
    problems_.push_back({t.offset, fmt::format("expected a number, found {}; 0 is taken", t.named())});
  } else if (t.kind == Kind::word) {
    add(value, Value::Kind::nodes, t);
    if (NodePtr node = readNode(names, depth)) value.nodes.push_back(std::move(node));
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
Parsed parsedNode(const mjcf::File& file, const Expansion& expansion) { return Parser(file, expansion).parseNode(); }

Error errorAt(const mjcf::File& file, std::size_t offset, const std::string& text) {
  return Error(fmt::format("{}:{}: {}", file.name, mjcf::lineAndColumn(file.text, offset), text));
}

}  // namespace spark::webots
