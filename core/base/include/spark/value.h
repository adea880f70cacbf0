#pragma once
/// \file
/// The value type that Lua, scene files, sparkctl and saved state exchange with the tree.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "spark/abi/spark/value.h"

namespace spark {

class Value;
/// A list of values. Vectors and matrices are lists of numbers, tables are lists of [key, value] pairs.
using List = std::vector<Value>;

/// nil, bool, integer, double, string or list. Plain data that owns what it holds.
class Value {
 public:
  /// The type of a value, in the order of the variant below.
  enum class Type { nil, boolean, integer, number, string, list };

  /// nil.
  Value() = default;
  /// A value of the type that corresponds to the argument's. Integers are stored as 64 bits; an unsigned one of 2^63 or
  /// more becomes the negative number of the same bits.
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
  /// Text as a person typed it (`--set K=TEXT`, sparkctl). It is a string until readAs() reads it as the type that its
  /// target expects.
  static Value typed(std::string_view text);

  /// The type of the value; `string` for typed text.
  Type type() const { return isTyped() ? Type::string : static_cast<Type>(data_.index()); }
  /// True for nil.
  bool isNil() const { return type() == Type::nil; }
  /// True for true and false.
  bool isBool() const { return type() == Type::boolean; }
  /// True for integers.
  bool isInteger() const { return type() == Type::integer; }
  /// True for integers and doubles.
  bool isNumber() const { return isInteger() || type() == Type::number; }
  /// True for strings, typed text included.
  bool isString() const { return type() == Type::string; }
  /// True for lists.
  bool isList() const { return type() == Type::list; }
  /// True for typed text, which is a string as well.
  bool isTyped() const { return std::holds_alternative<Typed>(data_); }

  /// The bool. Throws std::bad_variant_access for other types.
  bool toBool() const { return std::get<bool>(data_); }
  /// The integer. Throws std::bad_variant_access for other types.
  std::int64_t toInteger() const { return std::get<std::int64_t>(data_); }
  /// The double, or the integer as a double. Throws std::bad_variant_access for other types.
  double toNumber() const { return isInteger() ? static_cast<double>(toInteger()) : std::get<double>(data_); }
  /// The string, or the typed text. Throws std::bad_variant_access for other types. Valid while this value lives
  /// unchanged.
  const std::string& toString() const { return isTyped() ? std::get<Typed>(data_).text : std::get<std::string>(data_); }
  /// The list. Throws std::bad_variant_access for other types. Valid while this value lives unchanged.
  const List& toList() const { return std::get<List>(data_); }
  /// As above, to be changed in place.
  List& toList() { return std::get<List>(data_); }

  /// The value of `key` in a list of [key, value] pairs, else nullptr. Valid while this value lives unchanged.
  const Value* at(std::string_view key) const;
  /// Element `index` of a list, from 0, else nullptr. Valid while this value lives unchanged.
  const Value* at(std::size_t index) const;

  /// The value as people read it: `nil`, `true`, `3`, `0.1` (the shortest text that reads back), `"text"`, `{1, 2}`.
  std::string text() const;
  /// As text(), but a string is returned without quotes.
  std::string plain() const;
  /// Reads text as a person types it after `--set K=`: true, false, nil, a number, `{...}` or `[...]`. Any other text
  /// is a string. Never fails.
  static Value fromText(std::string_view text);
  /// Reads typed text as the type `typeName` (a name that Convert<T>::typeName() returns). A string is the text itself,
  /// without quotes around the whole; a list of strings keeps the text of each element; for every other type name the
  /// text is read by fromText(). Returns a value that is no typed text as it is.
  Value readAs(std::string_view typeName) const;

  /// True if type and contents are equal. The integer 1 and the double 1.0 differ, and so do typed text and a string.
  bool operator==(const Value&) const = default;

 private:
  struct Typed {
    std::string text;
    bool operator==(const Typed&) const = default;
  };
  std::variant<std::monostate, bool, std::int64_t, double, std::string, List, Typed> data_;
};

/// The name of a type: "nil", "bool", "integer", "number", "string" or "list".
std::string_view typeName(Value::Type type);

/// The arguments of one call. Convert<T>::from reads them from left to right.
struct Args {
  std::span<const Value> values;  ///< all arguments; the caller keeps them alive
  /// Lenient conversion, which the scene files of the installed base rely on: where a number is expected, text is read
  /// as C's atof reads it (garbage is 0), and integers are truncated and clamped.
  bool loose = false;
  std::size_t next = 0;  ///< index of the next argument

  /// True if no argument is left.
  bool atEnd() const { return next >= values.size(); }
  /// The number of arguments that have not been read.
  std::size_t left() const { return values.size() - next; }
  /// Returns the next argument and advances. Throws Error if there is none.
  const Value& take();
};

/// A value whose lists of [key, value] pairs with text keys are tables for scripts, at any depth; for all others they
/// are lists.
struct TableValue {
  Value value;
};

/// Converts between a C++ type and values. Specialise it for further types. A specialisation has:
/// - `kScalars`, the number of plain arguments that from() reads, or -1 for all that are left; a list of that length is
///   accepted in their place;
/// - `typeName()`, the name of the type in documentation and errors;
/// - `from(Args&)`, which reads a T and throws Error for arguments of the wrong type or number;
/// - `to(const T&)`, which makes a Value.
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
SPARK_CONVERT(TableValue, "table");
#undef SPARK_CONVERT

/// Reads all arguments that are left: either one list, or any number of plain arguments.
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
