#pragma once
/// \file
/// The value that crosses every border: Lua, scene files, sparkctl, state.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "spark/abi/spark/value.h"

namespace spark {

class Value;
/// A list of values; vectors, matrices and key-value tables (as lists of pairs) are lists.
using List = std::vector<Value>;

/// nil, bool, integer, double, string or list. Plain data, freely copied.
class Value {
 public:
  /// What a value holds; the order is that of the variant.
  enum class Type { nil, boolean, integer, number, string, list };

  Value() = default;
  Value(bool v) : data_(v) {}
  Value(int v) : data_(static_cast<std::int64_t>(v)) {}
  Value(unsigned v) : data_(static_cast<std::int64_t>(v)) {}
  Value(std::int64_t v) : data_(v) {}
  Value(std::uint64_t v) : data_(static_cast<std::int64_t>(v)) {}
  Value(double v) : data_(v) {}
  Value(const char* v) : data_(std::string(v)) {}
  Value(std::string v) : data_(std::move(v)) {}
  Value(std::string_view v) : data_(std::string(v)) {}
  Value(List v) : data_(std::move(v)) {}
  /// Text as a person typed it (`--set K=TEXT`, sparkctl): a string that is not read before it is known what it is for.
  /// See readAs.
  static Value typed(std::string_view text);

  Type type() const { return isTyped() ? Type::string : static_cast<Type>(data_.index()); }
  bool isNil() const { return type() == Type::nil; }
  bool isBool() const { return type() == Type::boolean; }
  bool isInteger() const { return type() == Type::integer; }
  /// True for integers and doubles.
  bool isNumber() const { return isInteger() || type() == Type::number; }
  bool isString() const { return type() == Type::string; }
  bool isList() const { return type() == Type::list; }
  /// True for what typed() made; such a value is a string as well.
  bool isTyped() const { return std::holds_alternative<Typed>(data_); }

  /// The value as the named type. Precondition: it is of that type (`toNumber` also takes integers).
  bool toBool() const { return std::get<bool>(data_); }
  std::int64_t toInteger() const { return std::get<std::int64_t>(data_); }
  double toNumber() const { return isInteger() ? static_cast<double>(toInteger()) : std::get<double>(data_); }
  const std::string& toString() const { return isTyped() ? std::get<Typed>(data_).text : std::get<std::string>(data_); }
  const List& toList() const { return std::get<List>(data_); }
  List& toList() { return std::get<List>(data_); }

  /// In a list of [key, value] pairs the value of `key`, else nullptr. Valid while this value lives unchanged.
  const Value* at(std::string_view key) const;
  /// Element `index` (0-based) of a list, else nullptr. Valid while this value lives unchanged.
  const Value* at(std::size_t index) const;

  /// For people: `nil`, `true`, `3`, `0.1` (shortest text that reads back), `"text"`, `{1, 2}`.
  std::string text() const;
  /// Bare strings without quotes, otherwise as text().
  std::string plain() const;
  /// Reads what a person types after `--set K=`: true, false, nil, numbers, `{...}` or `[...]`; all else is a string.
  static Value fromText(std::string_view text);
  /// What typed text means where a type is expected (named as Convert<T>::typeName() does): for a string the text
  /// itself, without quotes around all of it; for a list of strings its texts; for anything else, an unknown type
  /// included, as fromText reads it. Other values are what they are.
  Value readAs(std::string_view typeName) const;

  bool operator==(const Value&) const = default;

 private:
  struct Typed {
    std::string text;
    bool operator==(const Typed&) const = default;
  };
  std::variant<std::monostate, bool, std::int64_t, double, std::string, List, Typed> data_;
};

/// "nil", "bool", "integer", "number", "string", "list".
std::string_view typeName(Value::Type type);

/// The arguments of one call, read from left to right by Convert<T>::from.
struct Args {
  std::span<const Value> values;
  /// What the installed base's scene files rely on: text where a number is due is read as C atof does (garbage is 0).
  bool loose = false;
  std::size_t next = 0;

  bool atEnd() const { return next >= values.size(); }
  std::size_t left() const { return values.size() - next; }
  /// The next value; throws Error when there is none.
  const Value& take();
};

/// How a C++ type is made from arguments and turned into a value. Specialise it for types of your own; `kScalars` is
/// the number of plain arguments it reads (a list of that length is taken as well), -1 for "the rest".
template <class T>
struct Convert;

#define SPARK_CONVERT(Type, Name)                  \
  template <>                                      \
  struct Convert<Type> {                           \
    static constexpr int kScalars = 1;             \
    static std::string typeName() { return Name; } \
    static Type from(Args& args);                  \
    static Value to(const Type& v);                \
  }
SPARK_CONVERT(bool, "bool");
SPARK_CONVERT(int, "integer");
SPARK_CONVERT(std::int64_t, "integer");
SPARK_CONVERT(std::uint64_t, "integer");
SPARK_CONVERT(double, "number");
SPARK_CONVERT(float, "number");
SPARK_CONVERT(std::string, "string");
SPARK_CONVERT(Value, "any");
#undef SPARK_CONVERT

/// A list takes all that is left: one list, or any number of plain arguments.
template <class T>
struct Convert<std::vector<T>> {
  static constexpr int kScalars = -1;
  static std::string typeName() { return "list of " + Convert<T>::typeName(); }
  static std::vector<T> from(Args& args) {
    std::vector<T> out;
    if (args.left() == 1 && args.values[args.next].isList()) {
      Args inner{args.values[args.next++].toList(), args.loose};
      while (!inner.atEnd()) out.push_back(Convert<T>::from(inner));
    } else {
      while (!args.atEnd()) out.push_back(Convert<T>::from(args));
    }
    return out;
  }
  static Value to(const std::vector<T>& v) {
    List out;
    for (const T& e : v) out.push_back(Convert<T>::to(e));
    return out;
  }
};

}  // namespace spark
