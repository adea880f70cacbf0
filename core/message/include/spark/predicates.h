#pragma once
/// \file
/// Predicates: nested lists of atoms in one flat buffer. Parsers fill it from bytes, effectors read it and perceptors
/// write it. A buffer that is reused from cycle to cycle allocates nothing in steady state. Also the reader and writer
/// of S-expressions that scene files, agents and monitors share.

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

class StateReader;
class StateWriter;

/// One token of the buffer: an atom, or the head of a list, whose elements follow. Tokens refer to each other by sizes
/// only, and short texts are stored in the token, so that the tokens of a list can be copied as they are.
struct Token {
  /// What a token is.
  enum class Kind : std::uint8_t { list, text, number, integer };
  static constexpr std::uint32_t kShort = 8;  ///< the longest text that is stored in the token [bytes]
  Kind kind = Kind::text;
  bool quoted = false;     ///< of a text: it was written in quotes
  std::uint32_t size = 0;  ///< of a list: its tokens, this one included; of a text: bytes
  union {
    double number;             ///< of a number
    std::int64_t integer = 0;  ///< of an integer
    char letters[kShort];      ///< of a text of at most kShort bytes
    std::size_t begin;         ///< of a longer text: its offset in the text store
    std::uint32_t outer;       ///< of a list that is still open: index of the open list around it
  };
};
static_assert(sizeof(Token) == 16);

class Predicates;

/// A view of one element: a list or an atom. Valid while its Predicates is unchanged. Unless said otherwise, calls
/// require that the element is not empty.
class Element {
 public:
  /// The empty element.
  Element() = default;
  /// The element whose first token has that index.
  Element(const Predicates& owner, std::uint32_t index) : owner_(&owner), index_(index) {}
  /// False for the empty element.
  explicit operator bool() const { return owner_ != nullptr; }
  /// The element's first token.
  const Token& token() const;
  /// True for a list.
  bool isList() const { return token().kind == Token::Kind::list; }
  /// True for an atom that was written as text.
  bool isText() const { return token().kind == Token::Kind::text; }
  /// The text of an atom, "" for lists and numbers.
  std::string_view text() const;
  /// The number, or the text as C's atof reads it: garbage is 0, characters behind a number are ignored. 0 for a list.
  double number() const;
  /// The number, or a text that C's strtod reads completely (inf and nan included, blanks excluded). Nothing for other
  /// texts, for lists and for the empty element.
  std::optional<double> asNumber() const;
  /// True if asNumber() returns a number.
  bool isNumber() const { return asNumber().has_value(); }
  /// number() truncated. Numbers out of range are clamped, NaN is 0.
  std::int64_t integer() const;
  /// The line where the element was read, from 1; 0 if it was not read from text.
  std::uint32_t line() const;
  /// The column [bytes] where the element was read, from 1; 0 if it was not read from text.
  std::uint32_t column() const;

  /// The number of elements of a list, 0 for atoms. Takes linear time.
  std::size_t size() const;
  /// Element `i` of a list, from 0; empty if there is none. Takes linear time.
  Element at(std::size_t i) const;
  /// The text of a list's first element, which is the name of a predicate. "" if the first element is not a text.
  std::string_view head() const;
  /// A named parameter: the first sub-list with that head and at least two elements, empty if there is none.
  Element named(std::string_view name) const;
  /// The index of the first token.
  std::uint32_t index() const { return index_; }

  /// Iterates over the elements of a list.
  class Iterator {
   public:
    /// At the element whose first token has that index.
    Iterator(const Predicates& owner, std::uint32_t index) : owner_(&owner), index_(index) {}
    /// The element.
    Element operator*() const { return Element(*owner_, index_); }
    /// Moves to the next element.
    Iterator& operator++() {
      index_ = Element(*owner_, index_).behind();
      return *this;
    }
    /// True if the positions differ.
    bool operator!=(const Iterator& o) const { return index_ != o.index_; }

   private:
    const Predicates* owner_;
    std::uint32_t index_;
  };
  /// The first element of a list. An atom has none.
  Iterator begin() const { return {*owner_, isList() ? index_ + 1 : index_}; }
  /// Behind the last element.
  Iterator end() const { return {*owner_, isList() ? behind() : index_}; }

 private:
  friend class Predicates;
  /// Index of the token behind the element.
  std::uint32_t behind() const { return index_ + (isList() ? token().size : 1); }
  double numberInText() const;
  const Predicates* owner_ = nullptr;
  std::uint32_t index_ = 0;
};

/// A sequence of top-level elements, usually lists: `(he1 1.2)(init (name red))`.
class Predicates {
 public:
  /// Removes all elements and keeps the memory.
  void clear();
  /// True if there are no elements.
  bool empty() const { return tokens_.empty(); }

  /// Begins a list, with `name` as its first element unless it is empty. What is added next is inside it until close().
  /// Every open() needs one close(), see isUnbalanced().
  Predicates& open(std::string_view name = {}) {
    Token t;
    t.kind = Token::Kind::list;
    t.size = 1;
    t.outer = open_;
    open_ = size();
    push(t);
    return name.empty() ? *this : add(name);
  }
  /// Ends the innermost open list.
  Predicates& close() {
    if (open_ == kNone) return surplus_ = true, *this;
    Token& t = tokens_[open_];
    t.size = size() - open_;
    open_ = t.outer;
    return *this;
  }
  /// Adds a text, which is copied. `quoted`: it is written in quotes.
  Predicates& add(std::string_view text, bool quoted = false) {
    Token t;
    t.quoted = quoted;
    t.size = static_cast<std::uint32_t>(text.size());
    if (text.size() <= Token::kShort)
      text.copy(t.letters, Token::kShort);
    else
      t.begin = store(text);
    push(t);
    return *this;
  }
  /// Adds a text, which is copied.
  Predicates& add(const char* text) { return add(std::string_view(text)); }
  /// Adds a number.
  Predicates& add(double number) {
    Token t;
    t.kind = Token::Kind::number;
    t.number = number;
    push(t);
    return *this;
  }
  /// Adds an integer.
  Predicates& add(std::int64_t integer) {
    Token t;
    t.kind = Token::Kind::integer;
    t.integer = integer;
    push(t);
    return *this;
  }
  /// Adds an integer.
  Predicates& add(int integer) { return add(static_cast<std::int64_t>(integer)); }
  /// Adds the list `(name value)`.
  template <class T>
  Predicates& pair(std::string_view name, const T& value) {
    return open(name).add(value).close();
  }
  /// True if a list is open, or close() was called without one since the last clear() or balance(). Both are
  /// programming errors at the end of a message.
  bool isUnbalanced() const { return open_ != kNone || surplus_; }
  /// Closes all open lists. Returns their number, or -1 if none was open but close() was called once too often, or 0 if
  /// there was no error.
  int balance();
  /// Sets the line and column, from 1, of the token that was added last.
  void mark(std::uint32_t line, std::uint32_t column);
  /// Removes token `index` and all that follow, such as an expression that a reader could not finish.
  void truncate(std::uint32_t index);
  /// Adds a copy of an element of another buffer.
  void append(const Element& element);
  /// Replaces the atom whose token has that index by a number.
  void set(std::uint32_t index, double number) {
    Token& t = atom(index, Token::Kind::number);
    t.number = number;
  }
  /// Replaces the atom whose token has that index by an integer.
  void set(std::uint32_t index, std::int64_t integer) {
    Token& t = atom(index, Token::Kind::integer);
    t.integer = integer;
  }

  /// The first top-level element.
  Element::Iterator begin() const { return {*this, 0}; }
  /// Behind the last top-level element.
  Element::Iterator end() const { return {*this, size()}; }
  /// All tokens. Valid until the next change.
  const std::vector<Token>& tokens() const { return tokens_; }
  /// The text of a token of this buffer. Valid until the next change; a short text also only while the token lives.
  std::string_view textOf(const Token& t) const {
    return {t.size <= Token::kShort ? t.letters : text_.data() + t.begin, t.size};
  }
  /// A temporary token cannot hold a text.
  std::string_view textOf(Token&&) const = delete;
  /// The number of tokens.
  std::uint32_t size() const { return static_cast<std::uint32_t>(tokens_.size()); }

 private:
  friend class Element;
  struct Place {
    std::uint32_t line = 0, column = 0;
  };
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);
  std::size_t store(std::string_view text);
  /// An atom, which becomes one of another kind.
  Token& atom(std::uint32_t index, Token::Kind kind) {
    SPARK_ASSERT(index < size() && tokens_[index].kind != Token::Kind::list);
    tokens_[index] = {};
    tokens_[index].kind = kind;
    return tokens_[index];
  }
  /// Adds a token. It is always inlined, because perceptors add most of their tokens here. The slow path for a full
  /// vector is a separate function, so that the fast path is only a few instructions.
  [[gnu::always_inline]] void push(const Token& t) {
    if (tokens_.size() == tokens_.capacity()) [[unlikely]]
      grow();
    if (tokens_.size() == tokens_.capacity()) __builtin_unreachable();
    tokens_.push_back(t);
  }
  [[gnu::cold, gnu::noinline]] void grow();

  std::vector<Token> tokens_;
  std::string text_;            ///< the text store: all texts that are too long for their tokens
  std::vector<Place> places_;   ///< of all tokens up to the last one with a mark
  std::uint32_t open_ = kNone;  ///< index of the innermost open list
  bool surplus_ = false;        ///< close() was called without an open list
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

/// The top-level elements as a list of values (lists, strings, numbers), for scripts and tools. Allocates.
List toList(const Predicates& predicates);
/// Adds the values as top-level elements. Bools and nil become texts.
void append(const List& values, Predicates& out);
/// Saves the top-level elements: writes what toList() returns, but allocates nothing.
void savePredicates(const Predicates& predicates, StateWriter& out);
/// Replaces `to` by the elements that savePredicates() wrote. Throws what StateReader::readValue() throws.
void loadPredicates(StateReader& in, Predicates& to);

/// True for a text that can be written without quotes: it has no blanks, control characters, brackets, quotes,
/// backslashes and semicolons, and is not empty.
bool isWord(std::string_view text);
/// "" if the value can be written in any language of agents and monitors: a finite number, a word, a bool, or a list of
/// these. Otherwise what was expected and found.
std::string whyUnwritable(const Value& value);

/// The result of reading S-expressions.
struct ReadResult {
  std::string message;                 ///< the error, "" if everything was read
  std::uint32_t line = 0, column = 0;  ///< of the error, from 1
  std::size_t consumed = 0;            ///< bytes read
};

/// Limits for bytes from outside.
struct ReadLimits {
  std::uint32_t maxDepth = 64;      ///< levels of nested lists
  std::uint32_t maxTokens = 65536;  ///< tokens of one call
  bool places = true;               ///< elements get the line and column where they were read
};

/// Reads top-level expressions of the sfsexp dialect and adds them to `out`, at most `maxExpressions` of them (0: all).
/// The dialect has atoms, quoting by "..." and '...', escapes by backslash, and comments that begin with ';' where a
/// token may begin. Atoms become tokens of kind text; numbers are not recognised. After an error `out` has the complete
/// expressions in front of it. Never throws for bad bytes.
ReadResult readSexp(std::string_view bytes, Predicates& out, const ReadLimits& limits = {},
                    std::size_t maxExpressions = 0);

/// Appends all top-level elements as S-expressions in the form that agents and monitors of the installed base expect:
/// `(name a b)`, with a blank behind the name even if there are no arguments. Numbers have `decimals` fixed decimals;
/// `doubles` is passed to putFixed().
void writeSexp(const Predicates& predicates, int decimals, std::string& out, DoubleRange doubles = {});

}  // namespace spark
