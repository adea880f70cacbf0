#include "spark/predicates.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace spark {

const Token& Element::token() const { return owner_->tokens()[index_]; }

std::string_view Element::text() const {
  const Token& t = token();
  return t.kind == Token::Kind::text ? owner_->textOf(t) : std::string_view();
}

double Element::number() const {
  const Token& t = token();
  switch (t.kind) {
    case Token::Kind::number: return t.number;
    case Token::Kind::integer: return static_cast<double>(t.integer);
    case Token::Kind::list: return 0;
    case Token::Kind::text: break;
  }
  // atof wants a terminated string; numbers are short.
  char buffer[64];
  const std::string_view s = owner_->textOf(t);
  const std::size_t n = s.size();
  if (n >= sizeof buffer) return std::atof(std::string(s).c_str());
  s.copy(buffer, n);
  buffer[n] = 0;
  return std::atof(buffer);
}

std::int64_t Element::integer() const {
  if (token().kind == Token::Kind::integer) return token().integer;
  const double d = number();
  if (std::isnan(d)) return 0;
  if (d >= 9.2e18) return std::numeric_limits<std::int64_t>::max();
  if (d <= -9.2e18) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(d);
}

Element::Iterator& Element::Iterator::operator++() {
  const Token& t = owner_->tokens()[index_];
  index_ = t.kind == Token::Kind::list ? t.end : index_ + 1;
  return *this;
}

Element::Iterator Element::begin() const { return {*owner_, isList() ? index_ + 1 : index_}; }
Element::Iterator Element::end() const { return {*owner_, isList() ? token().end : index_}; }

std::size_t Element::size() const {
  std::size_t n = 0;
  for (auto it = begin(); it != end(); ++it) ++n;
  return n;
}

Element Element::at(std::size_t i) const {
  for (const Element e : *this)
    if (i-- == 0) return e;
  return {};
}

std::string_view Element::head() const {
  const Element first = at(0);
  return first ? first.text() : std::string_view();
}

Element Element::named(std::string_view name) const {
  for (const Element e : *this)
    if (e.isList() && e.head() == name && e.at(1)) return e;
  return {};
}

void Predicates::clear() {
  tokens_.clear();
  text_.clear();
  openLists_.clear();
}

Predicates& Predicates::open(std::string_view name) {
  Token t;
  t.kind = Token::Kind::list;
  openLists_.push_back(size());
  t.end = size() + 1;
  tokens_.push_back(t);
  if (!name.empty()) add(name);
  return *this;
}

Predicates& Predicates::close() {
  tokens_[openLists_.back()].end = size();
  openLists_.pop_back();
  return *this;
}

Predicates& Predicates::add(std::string_view text, bool quoted) {
  Token t;
  t.quoted = quoted;
  t.begin = static_cast<std::uint32_t>(text_.size());
  t.size = static_cast<std::uint32_t>(text.size());
  text_.append(text);
  tokens_.push_back(t);
  return *this;
}

Predicates& Predicates::add(double number) {
  Token t;
  t.kind = Token::Kind::number;
  t.number = number;
  tokens_.push_back(t);
  return *this;
}

Predicates& Predicates::add(std::int64_t integer) {
  Token t;
  t.kind = Token::Kind::integer;
  t.integer = integer;
  tokens_.push_back(t);
  return *this;
}

void Predicates::mark(std::uint32_t line, std::uint32_t column) {
  tokens_.back().line = line;
  tokens_.back().column = column;
}

void Predicates::truncate(std::uint32_t index) {
  if (index >= size()) return;
  for (std::uint32_t i = index; i < size(); ++i)
    if (tokens_[i].kind == Token::Kind::text) {
      text_.resize(tokens_[i].begin);
      break;
    }
  tokens_.resize(index);
  while (!openLists_.empty() && openLists_.back() >= index) openLists_.pop_back();
}

void Predicates::append(const Element& e) {
  const Token& t = e.token();
  switch (t.kind) {
    case Token::Kind::text: add(e.text(), t.quoted); break;
    case Token::Kind::number: add(t.number); break;
    case Token::Kind::integer: add(t.integer); break;
    case Token::Kind::list:
      open();
      for (const Element inner : e) append(inner);
      close();
  }
}

namespace {

bool isBlank(unsigned char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
bool isAtom(unsigned char c) { return (c >= 0x2A && c <= 0x7E) || c == '!' || (c >= 0x23 && c <= 0x26) || c > 0x7F; }
bool isEscapable(char c) { return c == '"' || c == '\'' || c == '(' || c == ')' || c == '\\'; }

/// One pass over the bytes with an explicit depth: no recursion, whatever the nesting.
class Reader {
 public:
  Reader(std::string_view bytes, Predicates& out, const ReadLimits& limits) : bytes_(bytes), out_(out), limits_(limits) {}

  ReadResult read(std::size_t maxExpressions) {
    std::size_t complete = 0;
    const std::uint32_t firstToken = out_.size();
    std::uint32_t expressionStart = firstToken;
    while (!result_.message.size()) {
      if (depth_ == 0 && maxExpressions && complete == maxExpressions) break;
      skipBlanksAndComments();
      if (at_ >= bytes_.size()) break;
      if (depth_ == 0) expressionStart = out_.size();
      if (bytes_[at_] != ')' && out_.size() - firstToken >= limits_.maxTokens) {
        fail("more than " + std::to_string(limits_.maxTokens) + " tokens");
        break;
      }
      const char c = bytes_[at_];
      const std::uint32_t line = line_, column = column_;
      if (c == '(') {
        if (depth_ == limits_.maxDepth) {
          fail("lists nested deeper than " + std::to_string(limits_.maxDepth));
          break;
        }
        out_.open();
        out_.mark(line, column);
        ++depth_;
        step();
      } else if (c == ')') {
        if (depth_ == 0) {
          fail("')' without '('");
          break;
        }
        out_.close();
        --depth_;
        step();
      } else {
        atom();
        if (!result_.message.empty()) break;
        out_.mark(line, column);
      }
      if (depth_ == 0) {
        ++complete;
        expressionStart = out_.size();
      }
    }
    if (result_.message.empty() && depth_ > 0) {
      fail("the list is not closed");
      result_.line = out_.tokens()[expressionStart].line;
      result_.column = out_.tokens()[expressionStart].column;
    }
    if (!result_.message.empty()) out_.truncate(expressionStart);
    result_.consumed = at_;
    return result_;
  }

 private:
  void fail(std::string message) { fail(std::move(message), line_, column_); }
  void fail(std::string message, std::uint32_t line, std::uint32_t column) {
    result_.message = std::move(message);
    result_.line = line;
    result_.column = column;
  }
  void step() {
    if (bytes_[at_] == '\n') ++line_, column_ = 1;
    else ++column_;
    ++at_;
  }
  void skipBlanksAndComments() {
    while (at_ < bytes_.size()) {
      if (isBlank(static_cast<unsigned char>(bytes_[at_]))) {
        step();
      } else if (bytes_[at_] == ';') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') step();
      } else {
        return;
      }
    }
  }
  void escapeOrByte() {
    if (bytes_[at_] == '\\' && at_ + 1 < bytes_.size() && isEscapable(bytes_[at_ + 1])) step();
    text_ += bytes_[at_];
    step();
  }
  void atom() {
    text_.clear();
    const std::uint32_t line = line_, column = column_;
    const char c = bytes_[at_];
    if (c == '"') {
      step();
      while (at_ < bytes_.size() && bytes_[at_] != '"') escapeOrByte();
      if (at_ >= bytes_.size()) return fail("the string is not closed", line, column);
      step();
      out_.add(text_, true);
    } else if (c == '\'') {
      step();
      if (at_ < bytes_.size() && bytes_[at_] == '(') {
        quotedList(line, column);
      } else {
        while (at_ < bytes_.size() && isAtom(static_cast<unsigned char>(bytes_[at_]))) escapeOrByte();
        if (at_ < bytes_.size() && bytes_[at_] == '\'') step();
      }
      if (result_.message.empty()) out_.add(text_, true);
    } else if (isAtom(static_cast<unsigned char>(c))) {
      while (at_ < bytes_.size() && isAtom(static_cast<unsigned char>(bytes_[at_]))) escapeOrByte();
      out_.add(text_);
    } else {
      constexpr char kHex[] = "0123456789abcdef";
      const auto byte = static_cast<unsigned char>(c);
      fail(std::string("byte 0x") + kHex[byte >> 4] + kHex[byte & 15] + " is no part of an atom");
    }
  }
  /// `'(...)`: kept as text.
  void quotedList(std::uint32_t line, std::uint32_t column) {
    std::size_t depth = 0;
    do {
      if (at_ >= bytes_.size()) return fail("the quoted list is not closed", line, column);
      if (bytes_[at_] == '(') ++depth;
      if (bytes_[at_] == ')') --depth;
      text_ += bytes_[at_];
      step();
    } while (depth > 0);
  }

  std::string_view bytes_;
  Predicates& out_;
  const ReadLimits& limits_;
  ReadResult result_;
  std::string text_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1, column_ = 1, depth_ = 0;
};

void writeElement(const Element& e, int decimals, bool top, std::string& out) {
  const Token& t = e.token();
  switch (t.kind) {
    case Token::Kind::text: out.append(e.text()); return;
    case Token::Kind::number: appendFixed(out, t.number, decimals); return;
    case Token::Kind::integer: {
      char buffer[24];
      out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, t.integer).ptr);
      return;
    }
    case Token::Kind::list: break;
  }
  out += '(';
  bool first = true;
  for (const Element inner : e) {
    if (!first) out += ' ';
    writeElement(inner, decimals, false, out);
    first = false;
  }
  if (top && e.token().end == e.index() + 2) out += ' ';
  out += ')';
}

}  // namespace

ReadResult readSexp(std::string_view bytes, Predicates& out, const ReadLimits& limits, std::size_t maxExpressions) {
  return Reader(bytes, out, limits).read(maxExpressions);
}

void writeSexp(const Predicates& predicates, int decimals, std::string& out) {
  for (const Element e : predicates) writeElement(e, decimals, true, out);
}

void appendFixed(std::string& out, double v, int decimals, bool asFloat) {
  char buffer[400];
  if (std::isnan(v)) {  // its sign, which to_chars would print, means nothing, and clients do not read it
    out += "nan";
    return;
  }
  // A clock in single precision stands still for some cycles after a few days, and clients end at two equal messages.
  constexpr double kLateClock = 65536, kEndOfClocks = 1e9;
  const bool clock = v >= kLateClock && v < kEndOfClocks;
  if (asFloat && !clock) v = static_cast<float>(v);
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::fixed, std::clamp(decimals, 0, 60));
  out.append(buffer, r.ptr);
}

}  // namespace spark
