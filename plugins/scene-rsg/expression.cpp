#include "expression.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "spark/error.h"

namespace spark::rsg {

namespace {

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// A recursive descent parser that evaluates while it parses.
///
///     sum     = product { ("+" | "-") product }
///     product = unary { ("*" | "/") unary }
///     unary   = { "+" | "-" } indexed
///     indexed = primary { "[" sum "]" }
///     primary = number | name [ "." name ] | quoted text | "(" sum ")"
class Expression {
 public:
  Expression(std::string_view text, const VariableLookup& lookup, bool integerDivision)
      : text_(text), rest_(text), lookup_(lookup), integerDivision_(integerDivision) {}
  /// Evaluates the whole text.
  Value evaluate() {
    Value v = sum();
    if (next() != '\0') fail("an operator or the end");
    return v;
  }

 private:
  static constexpr int kMaxDepth = 32;            // of parentheses and indices
  static constexpr std::size_t kShown = 200;      // bytes of the expression in messages
  static constexpr std::size_t kShownValue = 80;  // bytes of a value in messages
  static constexpr double kMaxIndex = 1e6;

  /// The next character that is no blank; 0 at the end.
  char next() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
    return rest_.empty() ? '\0' : rest_.front();
  }
  /// Consumes `c` if it is the next character.
  bool take(char c) {
    if (next() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  std::string_view shown() const { return text_.substr(0, kShown); }
  [[noreturn]] void fail(std::string_view expected) const {
    const std::string place = rest_.empty() ? "the end" : fmt::format("'{}'", rest_.substr(0, 20));
    throw Error(fmt::format("expected {} at {} of expression '{}'", expected, place, shown()));
  }
  /// Returns `v`. Throws Error unless it is a number.
  const Value& number(const Value& v) const {
    if (!v.isNumber())
      throw Error(fmt::format("expected a number to calculate with, found {} {} in expression '{}'", typeName(v.type()),
                              v.text().substr(0, kShownValue), shown()));
    return v;
  }
  /// The result of `a op b`.
  Value apply(char op, const Value& a, const Value& b) const;
  Value sum();
  Value product();
  Value unary();
  Value indexed();
  Value primary();
  Value name();
  Value literal();

  std::string_view text_;  ///< the expression
  std::string_view rest_;  ///< what is not parsed yet
  const VariableLookup& lookup_;
  bool integerDivision_;
  int depth_ = 0;
};

Value Expression::apply(char op, const Value& a, const Value& b) const {
  // Integers stay integers unless the result overflows. A division rounds down.
  if (number(a).isInteger() && number(b).isInteger()) {
    const std::int64_t x = a.toInteger(), y = b.toInteger();
    std::int64_t r = 0;
    if (op == '+' && !__builtin_add_overflow(x, y, &r)) return r;
    if (op == '-' && !__builtin_sub_overflow(x, y, &r)) return r;
    if (op == '*' && !__builtin_mul_overflow(x, y, &r)) return r;
    if (op == '/' && integerDivision_ && y != 0 && y != -1) return x / y - (x % y != 0 && (x < 0) != (y < 0));
  }
  const double x = a.toNumber(), y = number(b).toNumber();
  if (op == '/' && y == 0) throw Error(fmt::format("expected a divisor that is not 0 in expression '{}'", shown()));
  const double r = op == '+' ? x + y : op == '-' ? x - y : op == '*' ? x * y : x / y;
  if (!std::isfinite(r)) throw Error(fmt::format("the result of '{}' is too large", shown()));
  return r;
}

Value Expression::sum() {
  Value v = product();
  for (char op = next(); op == '+' || op == '-'; op = next()) {
    rest_.remove_prefix(1);
    v = apply(op, v, product());
  }
  return v;
}

Value Expression::product() {
  Value v = unary();
  for (char op = next(); op == '*' || op == '/'; op = next()) {
    rest_.remove_prefix(1);
    v = apply(op, v, unary());
  }
  return v;
}

Value Expression::unary() {
  bool negative = false, sign = false;
  for (char c = next(); c == '-' || c == '+'; c = next()) {
    sign = true;
    negative ^= c == '-';
    rest_.remove_prefix(1);
  }
  Value v = indexed();
  if (sign) number(v);
  return negative ? apply('-', Value(0), v) : v;
}

Value Expression::indexed() {
  if (++depth_ > kMaxDepth) fail("less nesting");
  Value v = primary();
  while (take('[')) {
    const Value index = sum();
    if (!take(']')) fail("']'");

    // A text is the key of a table, a whole number the index of a list.
    const Value* element = nullptr;
    if (index.isString())
      element = v.at(index.toString());
    else if (const double i = index.isNumber() ? index.toNumber() : -1; i >= 0 && i < kMaxIndex && i == std::floor(i))
      element = v.at(static_cast<std::size_t>(i));
    if (!element)
      throw Error(fmt::format("there is no element {} in expression '{}': found {}",
                              index.text().substr(0, kShownValue), shown(),
                              v.isList() ? fmt::format("a list of {}", v.toList().size()) : "no list"));
    Value inner = *element;
    v = std::move(inner);
  }
  --depth_;
  return v;
}

Value Expression::primary() {
  const char c = next();
  if (isDigit(c) || c == '.') return literal();
  if (isLetter(c)) return name();
  if (c == '\'' || c == '"') {
    const std::size_t end = rest_.find(c, 1);
    if (end == std::string_view::npos) fail("the closing quote");
    Value v(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return v;
  }
  if (!take('(')) fail("a number, a variable or '('");
  Value v = sum();
  if (!take(')')) fail("')'");
  return v;
}

Value Expression::literal() {
  const char* const begin = rest_.data();
  double d = 0;
  const auto r = std::from_chars(begin, begin + rest_.size(), d);
  if (r.ec != std::errc()) fail("a number");
  rest_.remove_prefix(r.ptr - begin);
  if (!rest_.empty() && (isLetter(rest_.front()) || rest_.front() == '.')) fail("an operator");
  // An integer if all its characters are digits and it fits.
  std::int64_t i = 0;
  const auto whole = std::from_chars(begin, r.ptr, i);
  if (whole.ec == std::errc() && whole.ptr == r.ptr) return i;
  return d;
}

Value Expression::name() {
  const auto word = [&] {
    std::size_t n = 0;
    while (n < rest_.size() && (isLetter(rest_[n]) || isDigit(rest_[n]))) ++n;
    const std::string_view w = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return w;
  };
  const std::string_view group = word();
  std::string_view member;
  if (!rest_.empty() && rest_.front() == '.') {
    rest_.remove_prefix(1);
    member = word();
    if (member.empty()) fail("a variable's name");
  }
  return lookup_(group, member);
}

}  // namespace

Value evaluate(std::string_view text, const VariableLookup& lookup, bool integerDivision) {
  return Expression(text, lookup, integerDivision).evaluate();
}

std::string resultText(const Value& value, bool digits6) {
  switch (value.type()) {
    case Value::Type::string:
      return value.toString();
    case Value::Type::boolean:
    case Value::Type::integer:
      return value.text();
    case Value::Type::number: {
      const float narrow = static_cast<float>(value.toNumber());
      if (!std::isfinite(narrow))
        throw Error(fmt::format("expected a finite number that fits single precision, found {}", value.text()));
      return digits6 ? fmt::format("{:.6g}", static_cast<double>(narrow)) : fmt::format("{}", value.toNumber());
    }
    default:
      throw Error(fmt::format("expected a number or a text as result, found a {}", typeName(value.type())));
  }
}

}  // namespace spark::rsg
