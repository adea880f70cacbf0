#pragma once
/// \file
/// Nested lists of atoms in one flat buffer: what parsers make of bytes, what effectors read and perceptors write.
/// Reused from cycle to cycle, it allocates nothing in steady state. And the S-expression reader that scene files,
/// agents and monitors share.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/predicates.h"
#include "spark/assert.h"
#include "spark/numbers.h"
#include "spark/value.h"

namespace spark {

/// One token of the buffer. Lists hold sizes and short texts stand in the token itself, so that a list means the same
/// wherever it is copied.
struct Token {
  enum class Kind : std::uint8_t { list, text, number, integer };
  static constexpr std::uint32_t kShort = 8;  ///< bytes of text that a token has room for
  Kind kind = Kind::text;
  bool quoted = false;     ///< text only: was written in quotes
  std::uint32_t size = 0;  ///< list: tokens in it, itself included; text: bytes
  union {
    double number;
    std::int64_t integer = 0;
    char letters[kShort];  ///< text of at most kShort bytes
    std::size_t begin;     ///< longer text: offset into the text store
    std::uint32_t outer;   ///< list that is still open: index of the open list around it
  };
};
static_assert(sizeof(Token) == 16);

class Predicates;

/// A view of one element. Valid while its Predicates is unchanged.
class Element {
 public:
  Element() = default;
  Element(const Predicates& owner, std::uint32_t index) : owner_(&owner), index_(index) {}
  explicit operator bool() const { return owner_ != nullptr; }
  const Token& token() const;
  bool isList() const { return token().kind == Token::Kind::list; }
  bool isText() const { return token().kind == Token::Kind::text; }
  /// The text of an atom; "" for lists and numbers.
  std::string_view text() const;
  /// A number: as written, or as C atof reads the text (garbage is 0, trailing junk ignored). Lists are 0.
  double number() const;
  /// The number when it is one: written as such, or a text that C's strtod reads to its end (with inf and nan, without
  /// blanks). Else nothing, where number() would be 0 or ignore what follows.
  std::optional<double> asNumber() const;
  bool isNumber() const { return asNumber().has_value(); }
  /// The number truncated; out of range is clamped, NaN is 0.
  std::int64_t integer() const;
  /// Where it was read, from 1; 0 when it was written.
  std::uint32_t line() const;
  std::uint32_t column() const;

  /// Number of elements of a list (0 for atoms). Linear.
  std::size_t size() const;
  /// Element i of a list, empty when there is none. Linear.
  Element at(std::size_t i) const;
  /// The first element's text: a predicate's name. "" when it is no text.
  std::string_view head() const;
  /// The first sub-list with that head and at least two elements, empty when there is none: named parameters.
  Element named(std::string_view name) const;
  std::uint32_t index() const { return index_; }

  /// Iterates over the elements of a list.
  class Iterator {
   public:
    Iterator(const Predicates& owner, std::uint32_t index) : owner_(&owner), index_(index) {}
    Element operator*() const { return Element(*owner_, index_); }
    Iterator& operator++() {
      index_ = Element(*owner_, index_).behind();
      return *this;
    }
    bool operator!=(const Iterator& o) const { return index_ != o.index_; }

   private:
    const Predicates* owner_;
    std::uint32_t index_;
  };
  Iterator begin() const { return {*owner_, isList() ? index_ + 1 : index_}; }
  Iterator end() const { return {*owner_, isList() ? behind() : index_}; }

 private:
  friend class Predicates;
  /// Index of the token behind it.
  std::uint32_t behind() const { return index_ + (isList() ? token().size : 1); }
  double numberInText() const;
  const Predicates* owner_ = nullptr;
  std::uint32_t index_ = 0;
};

/// A sequence of top-level elements, usually lists: `(he1 1.2)(init (name red))`.
class Predicates {
 public:
  void clear();
  bool empty() const { return tokens_.empty(); }

  /// Writing: open a list with a name (or none), add atoms, close it. Lists left open at the end, and closing what is
  /// not open, are programming errors: see isUnbalanced().
  Predicates& open(std::string_view name = {}) {
    Token t;
    t.kind = Token::Kind::list;
    t.size = 1;
    t.outer = open_;
    open_ = size();
    tokens_.push_back(t);
    return name.empty() ? *this : add(name);
  }
  Predicates& close() {
    if (open_ == kNone) return surplus_ = true, *this;
    Token& t = tokens_[open_];
    t.size = size() - open_;
    open_ = t.outer;
    return *this;
  }
  Predicates& add(std::string_view text, bool quoted = false) {
    Token t;
    t.quoted = quoted;
    t.size = static_cast<std::uint32_t>(text.size());
    if (text.size() <= Token::kShort)
      text.copy(t.letters, Token::kShort);
    else
      t.begin = store(text);
    tokens_.push_back(t);
    return *this;
  }
  Predicates& add(const char* text) { return add(std::string_view(text)); }
  Predicates& add(double number) {
    Token t;
    t.kind = Token::Kind::number;
    t.number = number;
    tokens_.push_back(t);
    return *this;
  }
  Predicates& add(std::int64_t integer) {
    Token t;
    t.kind = Token::Kind::integer;
    t.integer = integer;
    tokens_.push_back(t);
    return *this;
  }
  Predicates& add(int integer) { return add(static_cast<std::int64_t>(integer)); }
  /// `(name value)`.
  template <class T>
  Predicates& pair(std::string_view name, const T& value) {
    return open(name).add(value).close();
  }
  /// True when lists are open, or more were closed than were open, since the last clear() or balance().
  bool isUnbalanced() const { return open_ != kNone || surplus_; }
  /// Closes the lists that are open. Returns what had been wrong: so many lists open, -1 when too many were closed, 0
  /// when all was well.
  int balance();
  /// Sets where the token just added was read.
  void mark(std::uint32_t line, std::uint32_t column);
  /// Removes everything from token `index` on (that a reader began and could not finish).
  void truncate(std::uint32_t index);
  /// Appends a copy of an element of another buffer.
  void append(const Element& element);

  Element::Iterator begin() const { return {*this, 0}; }
  Element::Iterator end() const { return {*this, size()}; }
  const std::vector<Token>& tokens() const { return tokens_; }
  /// The text of a token of this buffer; it may stand in the token.
  std::string_view textOf(const Token& t) const {
    return {t.size <= Token::kShort ? t.letters : text_.data() + t.begin, t.size};
  }
  std::string_view textOf(Token&&) const = delete;
  std::uint32_t size() const { return static_cast<std::uint32_t>(tokens_.size()); }

 private:
  friend class Element;
  struct Place {
    std::uint32_t line = 0, column = 0;
  };
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);
  std::size_t store(std::string_view text);

  std::vector<Token> tokens_;
  std::string text_;            ///< what does not stand in tokens
  std::vector<Place> places_;   ///< of the tokens up to the last that was marked
  std::uint32_t open_ = kNone;  ///< the innermost open list
  bool surplus_ = false;        ///< close() was called without one
};

inline const Token& Element::token() const {
  SPARK_ASSERT(owner_ && index_ < owner_->size());
  return owner_->tokens_[index_];
}
inline std::string_view Element::text() const {
  const Token& t = token();
  return t.kind == Token::Kind::text ? owner_->textOf(t) : std::string_view();
}
inline double Element::number() const {
  const Token& t = token();
  return t.kind == Token::Kind::number    ? t.number
         : t.kind == Token::Kind::text    ? numberInText()
         : t.kind == Token::Kind::integer ? static_cast<double>(t.integer)
                                          : 0;
}
inline Element Element::at(std::size_t i) const {
  if (!isList()) return {};
  const std::uint32_t end = behind();
  Element e(*owner_, index_ + 1);
  while (e.index_ < end && i-- > 0) e.index_ = e.behind();
  return e.index_ < end ? e : Element();
}
inline std::string_view Element::head() const {
  const Element first = at(0);
  return first ? first.text() : std::string_view();
}

/// The top-level elements as a list of values (lists, texts, numbers), for scripts and tools; allocates.
List toList(const Predicates& predicates);
/// Appends a list of values as top-level elements; bools and nil become texts.
void append(const List& values, Predicates& out);

/// What an S-expression reader met. `message` is empty when all was read.
struct ReadResult {
  std::string message;
  std::uint32_t line = 0, column = 0;
  std::size_t consumed = 0;  ///< bytes read
};

/// Limits of a reader of outside bytes.
struct ReadLimits {
  std::uint32_t maxDepth = 64;
  std::uint32_t maxTokens = 65536;
  bool places = true;  ///< elements know where they were read
};

/// Reads top-level expressions of the sfsexp dialect (atoms, "..." and '...' quoting, backslash escapes, ';' comments
/// where a token may start) and appends them to `out`; at most `maxExpressions` (0: all). At an error what was complete
/// before stays, the rest is dropped. Never throws on bad bytes. Text becomes tokens of kind text; numbers are not
/// recognised.
ReadResult readSexp(std::string_view bytes, Predicates& out, const ReadLimits& limits = {},
                    std::size_t maxExpressions = 0);

/// Writes all top-level elements as S-expressions as agents and monitors of the installed base expect them: `(name a
/// b)`, one blank after the name even without arguments, `decimals` fixed decimals for numbers; `doubles` as of
/// putFixed().
void writeSexp(const Predicates& predicates, int decimals, std::string& out, DoubleRange doubles = {});

}  // namespace spark
