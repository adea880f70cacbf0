#include "spark/predicates.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace spark {

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
    std::uint32_t expressionStart = firstToken, expressionLine = 1, expressionColumn = 1;
    while (!result_.message.size()) {
      if (depth_ == 0 && maxExpressions && complete == maxExpressions) break;
      skipBlanksAndComments();
      if (at_ >= bytes_.size()) break;
      if (depth_ == 0) expressionStart = out_.size(), expressionLine = line_, expressionColumn = column_;
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
        place(line, column);
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
        place(line, column);
      }
      if (depth_ == 0) {
        ++complete;
        expressionStart = out_.size();
      }
    }
    if (result_.message.empty() && depth_ > 0) {
      fail("the list is not closed");
      result_.line = expressionLine;
      result_.column = expressionColumn;
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
  void place(std::uint32_t line, std::uint32_t column) {
    if (limits_.places) out_.mark(line, column);
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
  if (top && e.token().size == 2) out += ' ';
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
