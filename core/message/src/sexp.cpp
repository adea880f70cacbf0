#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "spark/predicates.h"
#include "spark/read_message.h"

namespace spark {

namespace {

/// Classes of bytes. kAtom: part of an atom without quotes. kPlain: the same and no escape.
enum Class : std::uint8_t { kBlank = 1, kAtom = 2, kPlain = 4 };
/// The classes of each byte.
constexpr auto kClasses = [] {
  std::array<std::uint8_t, 256> out{};
  for (const unsigned char c : {' ', '\t', '\r', '\n'}) out[c] = kBlank;
  for (unsigned c = 0; c < out.size(); ++c)
    if ((c >= 0x2A && c <= 0x7E) || c == '!' || (c >= 0x23 && c <= 0x26) || c > 0x7F)
      out[c] = c == '\\' ? kAtom : kAtom | kPlain;
  return out;
}();
bool is(Class what, char c) { return kClasses[static_cast<unsigned char>(c)] & what; }
bool isEscapable(char c) { return c == '"' || c == '\'' || c == '(' || c == ')' || c == '\\'; }

/// The most mistakes of a message around which it is read. Each may cost a pass over the message.
constexpr int kMostMistakes = 100;

/// A list without its ')', and the line at which this was detected.
struct Unclosed {
  std::uint32_t line = 0, column = 0;  ///< of the list
  std::uint32_t siblingLine = 0;
};

/// Guesses from the indentation which list of a text lacks its ')'. A line that begins with '(' no further right than
/// the innermost list that began a line was probably meant as the sibling of that list, which then lacks its ')'. The
/// first such line counts. Finds nothing in a text whose lists are not indented.
class Indentation {
 public:
  explicit Indentation(std::string_view bytes) : bytes_(bytes) {}

  std::optional<Unclosed> read() {
    for (at_ = 0; at_ < bytes_.size() && !isFlatText_; ++at_) {
      const char c = bytes_[at_];
      if (c == '\n') {
        ++line_;
        lineStart_ = at_ + 1;
        fresh_ = true;
        continue;
      }
      if (c == ';')
        skipTo('\n');
      else if (c == '"')
        skipTo('"');
      else if (c == '(')
        open();
      else if (c == ')')
        close();
      fresh_ = fresh_ && is(kBlank, c);
    }
    return isFlatText_ ? std::nullopt : found_;
  }

 private:
  struct List {
    std::uint32_t line, column;
    bool first;  ///< it begins its line, and has more than '(' there
    bool flat;   ///< a line inside it begins in its column, or further left
  };
  std::uint32_t column() const { return static_cast<std::uint32_t>(at_ - lineStart_) + 1; }
  /// Skips a string up to its closing quote, or a comment up to the byte in front of the line's end.
  void skipTo(char end) {
    while (at_ + 1 < bytes_.size() && (bytes_[at_ + 1] != end || (end == '"' && bytes_[at_] == '\\'))) {
      ++at_;
      if (bytes_[at_] == '\n') ++line_, lineStart_ = at_ + 1;
    }
    if (end == '"') ++at_;
  }
  void open() {
    // Compare a list that begins its line with the innermost open list that begins a line.
    if (fresh_)
      for (std::size_t i = lists_.size(); i-- > 0;) {
        List& outer = lists_[i];
        if (!outer.first) continue;
        if (outer.column >= column()) {
          outer.flat = true;
          if (!found_) found_ = Unclosed{outer.line, outer.column, line_};
        }
        break;
      }
    const std::size_t next = bytes_.find_first_not_of(" \t\r", at_ + 1);
    lists_.push_back({line_, column(), fresh_ && next != std::string_view::npos && bytes_[next] != '\n', false});
  }
  void close() {
    if (lists_.empty()) return;
    // A ')' in the column of its '(' confirms that the elements in that column are meant to be inside.
    isFlatText_ = fresh_ && lists_.back().flat && lists_.back().column == column();
    lists_.pop_back();
  }

  std::string_view bytes_;
  std::size_t at_ = 0, lineStart_ = 0;
  std::uint32_t line_ = 1;
  bool fresh_ = true;        ///< this line has only blanks so far
  bool isFlatText_ = false;  ///< elements are not indented, so the layout gives no hint
  std::vector<List> lists_;
  std::optional<Unclosed> found_;
};

std::optional<Unclosed> findUnclosed(std::string_view bytes) { return Indentation(bytes).read(); }

/// Reads in one pass with an explicit depth: nested lists cost no stack.
class Reader {
 public:
  Reader(std::string_view bytes, Predicates& out, const ReadLimits& limits)
      : bytes_(bytes), out_(out), limits_(limits), firstToken_(out.size()) {}

  /// Reads at most `maxExpressions`, 0 is all, up to the first mistake.
  ReadResult read(std::size_t maxExpressions) {
    readOn(maxExpressions);
    result_.consumed = at_;
    return std::move(result_);
  }

  /// Reads all top-level expressions but those with a mistake.
  ReadResult readAround() {
    readOn(0);
    ReadResult first = result_;
    for (int mistakes = 1; failed_ && !isFull_ && mistakes < kMostMistakes && skipExpression(); ++mistakes) {
      failed_ = false;
      readOn(0);
    }
    first.consumed = at_;
    return first;
  }

 private:
  struct Place {
    std::uint32_t line = 1, column = 1;
  };
  void readOn(std::size_t maxExpressions) {
    std::size_t complete = 0;                     // top-level expressions
    std::uint32_t expressionStart = out_.size();  // token at which the current top-level expression begins
    Place expressionPlace;
    depth_ = 0;
    while (!failed_) {
      if (depth_ == 0 && maxExpressions && complete == maxExpressions) break;
      skipBlanksAndComments();
      if (at_ >= bytes_.size()) break;
      const char c = bytes_[at_];
      const Place place = here();
      if (depth_ == 0) expressionStart = out_.size(), expressionPlace = place, begin_ = {at_, lineStart_, line_};
      if (c != ')' && out_.size() - firstToken_ >= limits_.maxTokens) {
        isFull_ = true;
        fail(fmt::format("more than {} tokens", limits_.maxTokens), place);
        break;
      }
      if (c == '(') {
        if (depth_ == limits_.maxDepth) {
          fail(fmt::format("lists nested deeper than {}", limits_.maxDepth), place);
          break;
        }
        out_.open();
        mark(place);
        ++depth_;
        ++at_;
      } else if (c == ')') {
        if (depth_ == 0) {
          fail("')' without '('", place);
          break;
        }
        out_.close();
        --depth_;
        ++at_;
      } else {
        atom();
        if (failed_) break;
        mark(place);
      }
      if (depth_ == 0) {
        ++complete;
        expressionStart = out_.size();
      }
    }
    // Complete expressions stay, an incomplete one is removed.
    if (!failed_ && depth_ > 0) failUnclosed(expressionPlace);
    if (failed_) out_.truncate(expressionStart);
  }
  /// Moves behind the top-level expression that has a mistake. False if its end cannot be found.
  bool skipExpression() {
    // A quote that does not end may be the mistake. Then brackets count even behind quotes, and so they do from then
    // on.
    std::tie(at_, lineStart_, line_) = begin_;
    return (!ignoresQuotes_ && skipTo(findEnd(true))) || (ignoresQuotes_ = true, skipTo(findEnd(false)));
  }
  /// Moves to a byte behind the present one, which may be in another line. False for npos.
  bool skipTo(std::size_t end) {
    if (end == std::string_view::npos) return false;
    while (at_ < end) step();
    return true;
  }
  /// The byte behind the list that begins here, npos if it has no end; where no list begins, the next one.
  std::size_t findEnd(bool quotes) const {
    if (bytes_[at_] != '(') return std::min(bytes_.find('(', at_), bytes_.size());
    std::size_t depth = 0;
    bool isQuoted = false;
    for (std::size_t i = at_; i < bytes_.size(); ++i) {
      const char c = bytes_[i];
      if (c == '\\' && i + 1 < bytes_.size() && isEscapable(bytes_[i + 1]))
        ++i;
      else if (quotes && c == '"')
        isQuoted = !isQuoted;
      else if (!isQuoted && c == '(')
        ++depth;
      else if (!isQuoted && c == ')' && --depth == 0)
        return i + 1;
    }
    return std::string_view::npos;
  }
  Place here() const { return {line_, static_cast<std::uint32_t>(at_ - lineStart_) + 1}; }
  void fail(std::string message, Place place) {
    failed_ = true;
    result_.message = std::move(message);
    result_.line = place.line;
    result_.column = place.column;
  }
  /// Handles a text that ended inside a list. In an indented file, the indentation shows which list that is.
  void failUnclosed(Place place) {
    const std::optional<Unclosed> guess = limits_.places ? findUnclosed(bytes_) : std::nullopt;
    if (!guess) return fail("the list is not closed", place);
    fail(fmt::format("the list is not closed: line {} begins beside it", guess->siblingLine),
         {guess->line, guess->column});
  }
  void mark(Place place) {
    if (limits_.places) out_.mark(place.line, place.column);
  }
  /// Skips a byte that may end a line.
  void step() {
    if (bytes_[at_++] == '\n') ++line_, lineStart_ = at_;
  }
  void skipBlanksAndComments() {
    while (at_ < bytes_.size()) {
      if (is(kBlank, bytes_[at_])) {
        step();
      } else if (bytes_[at_] == ';') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
      } else {
        return;
      }
    }
  }
  /// Appends a byte, or the one behind a backslash, to the text of an atom.
  void escapeOrByte() {
    if (bytes_[at_] == '\\' && at_ + 1 < bytes_.size() && isEscapable(bytes_[at_ + 1])) step();
    text_ += bytes_[at_];
    step();
  }
  /// Reads an atom of any kind.
  void atom() {
    const char c = bytes_[at_];
    if (is(kPlain, c)) return plainAtom();
    text_.clear();
    const Place place = here();
    if (c == '"') {
      step();
      while (at_ < bytes_.size() && bytes_[at_] != '"') escapeOrByte();
      if (at_ >= bytes_.size()) return fail("the string is not closed", place);
      step();
      out_.add(text_, true);
    } else if (c == '\'') {
      step();
      if (at_ < bytes_.size() && bytes_[at_] == '(') {
        quotedList(place);
      } else {
        while (at_ < bytes_.size() && is(kAtom, bytes_[at_])) escapeOrByte();
        if (at_ < bytes_.size() && bytes_[at_] == '\'') step();
      }
      if (!failed_) out_.add(text_, true);
    } else if (is(kAtom, c)) {
      escapedAtom();
    } else {
      fail(fmt::format("byte 0x{:02x} is no part of an atom", static_cast<unsigned char>(c)), place);
    }
  }
  /// Reads an atom whose bytes are its text, as nearly all are.
  void plainAtom() {
    std::size_t end = at_ + 1;
    while (end < bytes_.size() && is(kPlain, bytes_[end])) ++end;
    if (end < bytes_.size() && is(kAtom, bytes_[end])) return text_.clear(), escapedAtom();
    out_.add(bytes_.substr(at_, end - at_));
    at_ = end;
  }
  /// Reads an atom that contains a backslash.
  void escapedAtom() {
    while (at_ < bytes_.size() && is(kAtom, bytes_[at_])) escapeOrByte();
    out_.add(text_);
  }
  /// Reads `'(...)` as one text.
  void quotedList(Place place) {
    std::size_t depth = 0;
    do {
      if (at_ >= bytes_.size()) return fail("the quoted list is not closed", place);
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
  const std::uint32_t firstToken_;  ///< size of `out_` at the beginning
  std::string text_;
  std::size_t at_ = 0, lineStart_ = 0;
  /// at_, lineStart_ and line_ where the current top-level expression begins.
  std::tuple<std::size_t, std::size_t, std::uint32_t> begin_{0, 0, 1};
  std::uint32_t line_ = 1, depth_ = 0;
  bool failed_ = false;
  bool isFull_ = false;         ///< the limit of tokens is reached
  bool ignoresQuotes_ = false;  ///< to find the end of an expression with a mistake
};

/// Buffer size for any token except a long text, with the brackets and blanks around it [bytes].
constexpr std::size_t kTokenRoom = kFixedRoom + 16;

/// How numbers are written.
struct Style {
  int decimals;
  DoubleRange doubles;
};

/// Writes a text in quotes, as the reader reads it back byte for byte.
void putQuoted(std::string_view text, ByteWriter& out) {
  out.put('"');
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of("\"\\", begin), text.size());
    out.put(text.substr(begin, end - begin));
    if (end < text.size()) out.put('\\'), out.put(text[end]);
    begin = end + 1;
  }
  out.put('"');
}

/// Not inlined: almost all texts are short words, and writing those is the time of a message.
[[gnu::noinline]] void putText(std::string_view text, bool quoted, ByteWriter& out) {
  if (quoted)
    putQuoted(text, out);
  else
    out.put(text);
}

/// The shortest digits that are read back as the same number.
char* putShortest(char* at, double v) {
  if (std::isnan(v)) return std::copy_n("nan", 3, at);
  return std::to_chars(at, at + kFixedRoom, v).ptr;
}

/// Writes the elements of tokens [t, end), separated by blanks. `at` must have kTokenRoom bytes available, and so has
/// the returned pointer. The pointer is passed by value so that it stays in a register; the writer's own position would
/// be stored and loaded for each byte.
char* writeElements(const Predicates& from, const Token* t, const Token* end, const Style& style, ByteWriter& out,
                    char* at) {
  const auto more = [&out](char* to) { return out.end(to), out.room(kTokenRoom); };
  while (t < end) {
    const Token* const next = t + (t->kind == Token::Kind::list ? t->size : 1);
    switch (t->kind) {
      case Token::Kind::text:
        if (t->size <= Token::kShort && !t->quoted) {
          std::memcpy(at, t->letters, Token::kShort);
          at += t->size;
        } else {
          out.end(at);
          putText(from.textOf(*t), t->quoted, out);
          at = out.room(kTokenRoom);
        }
        break;
      case Token::Kind::number:
        at = style.decimals < 0 ? putShortest(at, t->number) : putFixed(at, t->number, style.decimals, style.doubles);
        break;
      case Token::Kind::integer:
        out.end(at);
        out.integer(t->integer);
        at = out.room(kTokenRoom);
        break;
      case Token::Kind::list:
        *at++ = '(';
        at = writeElements(from, t + 1, next, style, out, at);
        *at++ = ')';
        break;
    }
    t = next;
    if (t < end) *at++ = ' ';
    at = more(at);
  }
  return at;
}

}  // namespace

ReadResult readSexp(std::string_view bytes, Predicates& out, const ReadLimits& limits, std::size_t maxExpressions) {
  return Reader(bytes, out, limits).read(maxExpressions);
}

ReadResult readMessage(std::string_view bytes, Predicates& out, const ReadLimits& limits) {
  return Reader(bytes, out, limits).readAround();
}

void writeSexp(const Predicates& predicates, int decimals, std::string& bytes, DoubleRange doubles) {
  const Style style{decimals, doubles};
  ByteWriter out(bytes);
  char* at = out.room(kTokenRoom);
  const Token* const end = predicates.tokens().data() + predicates.size();
  for (const Token* t = predicates.tokens().data(); t < end;) {
    const bool list = t->kind == Token::Kind::list;
    const Token* const next = t + (list ? t->size : 1);
    // A predicate without arguments has a blank after its name.
    if (list && t->size == 2) {
      *at++ = '(';
      at = writeElements(predicates, t + 1, next, style, out, at);
      *at++ = ' ';
      *at++ = ')';
    } else {
      at = writeElements(predicates, t, next, style, out, at);
    }
    t = next;
  }
  out.end(at);
}

}  // namespace spark
