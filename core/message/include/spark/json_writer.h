#pragma once
/// \file
/// Writes JSON text piece by piece, with commas, quotes and escapes.
///
///     std::string out;
///     JsonWriter json(out);
///     json.beginObject().member("time", 0.5).key("at").numbers(position).endObject();   // {"time":0.5,"at":[0,1,2]}

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "spark/abi/spark/json_writer.h"
#include "spark/numbers.h"
#include "spark/value.h"

namespace spark {

/// Choices that JSON leaves open.
struct JsonStyle {
  bool ascii = false;              ///< writes other characters as \uXXXX instead of UTF-8
  const char* notFinite = "null";  ///< written for numbers that are not finite
};

/// Appends one JSON value to a string. Call its functions in the order of the text: brackets and keys are not checked.
/// The text is complete in the string when the outermost bracket is closed, or when the writer is destroyed.
class JsonWriter {
 public:
  /// `out` must outlive the writer and must not be used before the text is complete.
  explicit JsonWriter(std::string& out, JsonStyle style = {}) : out_(out), style_(style) {}

  /// Begins an object. Its members follow, each as key() and a value.
  JsonWriter& beginObject() { return open('{'); }
  /// Ends an object.
  JsonWriter& endObject() { return close('}'); }
  /// Begins an array. Its values follow.
  JsonWriter& beginArray() { return open('['); }
  /// Ends an array.
  JsonWriter& endArray() { return close(']'); }
  /// Writes the key of a member, whose value follows.
  JsonWriter& key(std::string_view name);

  /// Writes a string in UTF-8. Invalid bytes become U+FFFD.
  JsonWriter& value(std::string_view text);
  /// Writes a string in UTF-8. Invalid bytes become U+FFFD.
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  /// Writes true or false.
  JsonWriter& value(bool v) { return raw(v ? "true" : "false"); }
  /// Writes an integer, up to 2^63 - 1.
  template <std::integral T>
  JsonWriter& value(T v) {
    return separate(), out_.integer(static_cast<std::int64_t>(v)), *this;
  }
  /// Writes a number with `digits` significant digits.
  JsonWriter& value(double v, int digits = 6);
  /// Writes a number with `decimals` decimals.
  JsonWriter& fixed(double v, int decimals);
  /// Writes a Value: lists as arrays, nil and numbers that are not finite as null.
  template <std::same_as<Value> V>
  JsonWriter& value(const V& v) {
    return anyValue(v);
  }
  /// Writes null.
  JsonWriter& null() { return raw("null"); }
  /// Writes a value that is JSON already.
  JsonWriter& raw(std::string_view json);

  /// Writes a key and its value.
  template <class T>
  JsonWriter& member(std::string_view name, const T& v) {
    return key(name).value(v);
  }
  /// Writes the members of an object that is JSON already, `{...}`, as members of the open object.
  JsonWriter& members(std::string_view object);
  /// Writes an array of numbers.
  template <class List>
  JsonWriter& numbers(const List& list) {
    beginArray();
    for (const auto v : list) value(v);
    return endArray();
  }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  /// Writes the comma between two values.
  void separate() {
    if (comma_) out_.put(',');
    comma_ = true;
  }
  void quote(std::string_view text);
  JsonWriter& anyValue(const Value& v);

  ByteWriter out_;
  JsonStyle style_;
  int depth_ = 0;       ///< open brackets
  bool comma_ = false;  ///< the next value needs a comma in front
};

}  // namespace spark
