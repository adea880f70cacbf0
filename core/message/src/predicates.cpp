#include "spark/predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spark {

double Element::numberInText() const { return readNumber(text()); }

std::optional<double> Element::asNumber() const {
  if (!owner_ || isList()) return std::nullopt;
  if (!isText()) return number();
  double v = 0;
  return readWholeNumber(text(), v) ? std::optional(v) : std::nullopt;
}

std::int64_t Element::integer() const {
  if (token().kind == Token::Kind::integer) return token().integer;
  const double d = number();
  constexpr double kLimit = 9.2e18;  // a little below 2^63
  if (std::isnan(d)) return 0;
  if (d >= kLimit) return std::numeric_limits<std::int64_t>::max();
  if (d <= -kLimit) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(d);
}

std::size_t Element::size() const {
  std::size_t n = 0;
  for (auto it = begin(); it != end(); ++it) ++n;
  return n;
}

Element Element::named(std::string_view name) const {
  for (const Element e : *this)
    if (e.isList() && e.head() == name && e.at(1)) return e;
  return {};
}

std::uint32_t Element::line() const { return index_ < owner_->places_.size() ? owner_->places_[index_].line : 0; }

std::uint32_t Element::column() const { return index_ < owner_->places_.size() ? owner_->places_[index_].column : 0; }

void Predicates::clear() {
  tokens_.clear();
  text_.clear();
  places_.clear();
  open_ = kNone;
  surplus_ = false;
}

int Predicates::balance() {
  int problem = surplus_ ? -1 : 0;
  for (; open_ != kNone; close()) problem = std::max(problem, 0) + 1;
  surplus_ = false;
  return problem;
}

void Predicates::grow() {
  constexpr std::size_t kFirst = 64;
  tokens_.reserve(std::max(kFirst, 2 * tokens_.capacity()));
}

/// Appends to the text store and returns the offset.
std::size_t Predicates::store(std::string_view text) {
  const std::size_t begin = text_.size();
  text_.append(text);
  return begin;
}

void Predicates::mark(std::uint32_t line, std::uint32_t column) {
  places_.resize(tokens_.size());
  places_.back() = {line, column};
}

void Predicates::truncate(std::uint32_t index) {
  if (index >= size()) return;
  // Texts are stored in the order of their tokens: the first one that is removed ends the store.
  for (std::uint32_t i = index; i < size(); ++i)
    if (const Token& t = tokens_[i]; t.kind == Token::Kind::text && t.size > Token::kShort) {
      text_.resize(t.begin);
      break;
    }
  // Lists that are removed are not open any more.
  while (open_ != kNone && open_ >= index) open_ = tokens_[open_].outer;
  tokens_.resize(index);
  places_.resize(std::min<std::size_t>(places_.size(), index));
}

void Predicates::append(const Element& e) {
  for (std::uint32_t i = e.index_, end = e.behind(); i < end; ++i) {
    Token t = e.owner_->tokens_[i];
    // Only longer texts refer to their buffer.
    if (t.kind == Token::Kind::text && t.size > Token::kShort) t.begin = store(e.owner_->textOf(e.owner_->tokens_[i]));
    push(t);
  }
}

}  // namespace spark
