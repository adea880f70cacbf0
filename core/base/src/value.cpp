#include "spark/value.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "spark/error.h"

namespace spark {

const Value* Value::at(std::string_view key) const {
  if (!isList()) return nullptr;
  for (const Value& entry : toList())
    if (entry.isList() && entry.toList().size() == 2 && entry.toList()[0].isString() &&
        entry.toList()[0].toString() == key)
      return &entry.toList()[1];
  return nullptr;
}

const Value* Value::at(std::size_t index) const {
  return isList() && index < toList().size() ? &toList()[index] : nullptr;
}

namespace {
/// The shortest text that reads back as `v` and is recognised as a double: "1.0", not "1".
std::string numberText(double v) {
  if (std::isnan(v)) return "nan";
  if (std::isinf(v)) return v < 0 ? "-inf" : "inf";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, v).ptr;
  std::string out(buffer, end);
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

void skipBlanks(std::string_view& t) {
  while (!t.empty() && (t.front() == ' ' || t.front() == '\t')) t.remove_prefix(1);
}

/// Reads nil, a bool or a number; all other text is a string.
Value scalarFromText(std::string_view t) {
  if (t == "nil") return {};
  if (t == "true") return true;
  if (t == "false") return false;
  const char* end = t.data() + t.size();
  // from_chars does not accept a leading '+'.
  const char* begin = t.size() > 1 && t.front() == '+' && t[1] != '-' ? t.data() + 1 : t.data();
  std::int64_t i = 0;
  if (auto r = std::from_chars(begin, end, i); r.ec == std::errc() && r.ptr == end) return i;
  double d = 0;
  if (auto r = std::from_chars(begin, end, d); r.ec == std::errc() && r.ptr == end) return d;
  return t;
}

/// Reads a word without quotes.
using ReadWord = Value (*)(std::string_view);

/// Removes one value from the front of `t` and returns it. Sets `ok` to false if a list is malformed.
Value valueFromText(std::string_view& t, ReadWord readWord, bool inList, int depth, bool& ok) {
  constexpr int kMaxNesting = 32;
  skipBlanks(t);
  // A list. Commas between its elements may be omitted.
  if (depth < kMaxNesting && !t.empty() && (t.front() == '{' || t.front() == '[')) {
    const char close = t.front() == '{' ? '}' : ']';
    t.remove_prefix(1);
    List list;
    for (skipBlanks(t); !t.empty() && t.front() != close; skipBlanks(t)) {
      list.push_back(valueFromText(t, readWord, true, depth + 1, ok));
      if (!ok) return {};
      skipBlanks(t);
      if (!t.empty() && t.front() == ',') t.remove_prefix(1);
    }
    ok = !t.empty();
    if (ok) t.remove_prefix(1);
    return list;
  }
  // A quoted string. Outside a list the quotes must enclose the whole text.
  if (!t.empty() && (t.front() == '"' || t.front() == '\'')) {
    if (const auto end = t.find(t.front(), 1); end != std::string_view::npos && (inList || end + 1 == t.size())) {
      Value v(t.substr(1, end - 1));
      t.remove_prefix(end + 1);
      return v;
    }
  }
  // A word: in a list up to the next separator, else the whole text.
  std::size_t n = inList ? t.find_first_of(",}] ") : t.size();
  if (n == std::string_view::npos) n = t.size();
  if (inList && n == 0) ok = false;
  Value v = readWord(t.substr(0, n));
  t.remove_prefix(n);
  return v;
}
}  // namespace

std::string Value::text() const {
  switch (type()) {
    case Type::nil:
      return "nil";
    case Type::boolean:
      return toBool() ? "true" : "false";
    case Type::integer:
      return std::to_string(toInteger());
    case Type::number:
      return numberText(toNumber());
    case Type::string:
      return fmt::format("\"{}\"", toString());
    case Type::list:
      break;
  }
  std::string out = "{";
  for (const Value& v : toList()) out += (out.size() > 1 ? ", " : "") + v.text();
  return out + "}";
}

std::string Value::plain() const { return isString() ? toString() : text(); }

namespace {
/// Reads the whole text as one value. Text that is not one well-formed value is a string.
Value allFromText(std::string_view text, ReadWord readWord) {
  std::string_view rest = text;
  bool ok = true;
  Value v = valueFromText(rest, readWord, false, 0, ok);
  skipBlanks(rest);
  return ok && rest.empty() ? v : Value(text);
}

/// `text` without the quotes that enclose the whole of it, if there are any.
std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                      text.find(text.front(), 1) == text.size() - 1;
  return quoted ? text.substr(1, text.size() - 2) : text;
}
}  // namespace

Value Value::fromText(std::string_view text) { return allFromText(text, scalarFromText); }

Value Value::typed(std::string_view text) {
  Value v;
  v.data_ = Typed{std::string(text)};
  return v;
}

Value Value::readAs(std::string_view typeName) const {
  if (!isTyped()) return *this;
  if (typeName == Convert<std::string>::typeName()) return unquoted(toString());
  if (typeName == Convert<std::vector<std::string>>::typeName())
    return allFromText(toString(), [](std::string_view word) { return Value(word); });
  return fromText(toString());
}

std::string_view typeName(Value::Type type) {
  constexpr std::string_view kNames[] = {"nil", "bool", "integer", "number", "string", "list"};
  return kNames[static_cast<int>(type)];
}

const Value& Args::take() {
  if (atEnd()) throw Error("expected one more argument");
  return values[next++];
}

namespace {
[[noreturn]] void wrongType(std::string_view expected, const Value& found) {
  throw Error(fmt::format("expected {}, found {} {}", expected, typeName(found.type()), found.text()));
}

/// Takes the next argument; a list of one element is unwrapped.
const Value& takeScalar(Args& args) {
  const Value& v = args.take();
  return v.isList() && v.toList().size() == 1 ? v.toList()[0] : v;
}

/// Takes a number, also written as text.
double numberFrom(Args& args) {
  const Value& v = takeScalar(args);
  if (v.isNumber()) return v.toNumber();
  if (v.isString()) {
    if (args.loose) return std::atof(v.toString().c_str());
    if (const Value parsed = scalarFromText(v.toString()); parsed.isNumber()) return parsed.toNumber();
  }
  if (args.loose && v.isBool()) return v.toBool();
  wrongType("number", v);
}

/// Takes an integer, also written as a double without fraction. Loose reading truncates, clamps to the range of I, and
/// reads numbers that are not finite or too large for exact digits as 0.
template <class I>
I integerFrom(Args& args) {
  constexpr double kMaxExact = 9e15;  // just below 2^53, from which on doubles skip integers
  const Value& next = args.atEnd() ? args.take() : args.values[args.next];  // take() throws at the end
  // An integer is never converted to double on the way.
  if (next.isInteger()) {
    const std::int64_t i = takeScalar(args).toInteger();
    if (i >= static_cast<std::int64_t>(std::numeric_limits<I>::min()) &&
        (sizeof(I) >= 8 || i <= static_cast<std::int64_t>(std::numeric_limits<I>::max())))
      return static_cast<I>(i);
    throw Error(fmt::format("expected an integer that fits, found {}", i));
  }
  const double d = numberFrom(args);
  if (!std::isfinite(d) || std::abs(d) > kMaxExact) {
    if (args.loose) return 0;
    throw Error(fmt::format("expected an integer, found {}", numberText(d)));
  }
  if (!args.loose && d != std::trunc(d)) throw Error(fmt::format("expected an integer, found {}", numberText(d)));
  constexpr double kLow = static_cast<double>(std::numeric_limits<I>::min()),
                   kHigh = static_cast<double>(std::numeric_limits<I>::max());
  if (d >= kLow && d <= kHigh) return static_cast<I>(d);
  if (!args.loose)
    throw Error(
        fmt::format("expected an integer of {} to {}, found {}", numberText(kLow), numberText(kHigh), numberText(d)));
  return d < kLow ? std::numeric_limits<I>::min() : std::numeric_limits<I>::max();
}
}  // namespace

bool Convert<bool>::from(Args& args) {
  const Value& v = takeScalar(args);
  if (v.isBool()) return v.toBool();
  if (v.isString() && v.toString() == "true") return true;
  if (v.isString() && v.toString() == "false") return false;
  if (v.isInteger() && !args.loose && (v.toInteger() == 0 || v.toInteger() == 1)) return v.toInteger() == 1;
  wrongType("bool (true or false)", v);
}
Value Convert<bool>::to(const bool& v) { return v; }
int Convert<int>::from(Args& args) { return integerFrom<int>(args); }
Value Convert<int>::to(const int& v) { return v; }
std::int64_t Convert<std::int64_t>::from(Args& args) { return integerFrom<std::int64_t>(args); }
Value Convert<std::int64_t>::to(const std::int64_t& v) { return v; }
std::uint64_t Convert<std::uint64_t>::from(Args& args) {
  // A Value holds the bits of a large unsigned number as a negative integer.
  if (!args.atEnd() && args.values[args.next].isInteger()) return static_cast<std::uint64_t>(args.take().toInteger());
  return integerFrom<std::uint64_t>(args);
}
Value Convert<std::uint64_t>::to(const std::uint64_t& v) { return v; }
double Convert<double>::from(Args& args) {
  const double v = numberFrom(args);
  return args.loose ? static_cast<float>(v) : v;  // the installed base has single precision
}
Value Convert<double>::to(const double& v) { return v; }
float Convert<float>::from(Args& args) { return static_cast<float>(numberFrom(args)); }
Value Convert<float>::to(const float& v) { return static_cast<double>(v); }
std::string Convert<std::string>::from(Args& args) {
  const Value& v = takeScalar(args);
  if (v.isString()) return v.toString();
  if (v.isNumber() || v.isBool()) return v.text();
  wrongType("string", v);
}
Value Convert<std::string>::to(const std::string& v) { return v; }
Value Convert<Value>::from(Args& args) { return args.take(); }
Value Convert<Value>::to(const Value& v) { return v; }
TableValue Convert<TableValue>::from(Args& args) { return {args.take()}; }
Value Convert<TableValue>::to(const TableValue& v) { return v.value; }

}  // namespace spark
