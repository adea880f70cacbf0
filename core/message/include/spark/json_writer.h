#pragma once
/// \file
/// JSON text, written as it is known: commas, quotes and escapes are the writer's.
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

/// What JSON leaves open.
struct JsonStyle {
  bool ascii = false;              ///< other characters become \uXXXX; else they are written as UTF-8
  const char* notFinite = "null";  ///< written for a number that is not finite
};

/// Appends one JSON value to a string. Calls come in the order of the text; brackets and keys are not checked. The text
/// is in the string when the outermost bracket is closed, or when the writer ends.
class JsonWriter {
 public:
  /// `out` must outlive the writer and not be touched before the text is complete.
  explicit JsonWriter(std::string& out, JsonStyle style = {}) : out_(out), style_(style) {}

  JsonWriter& beginObject() { return open('{'); }
  JsonWriter& endObject() { return close('}'); }
  JsonWriter& beginArray() { return open('['); }
  JsonWriter& endArray() { return close(']'); }
  /// In front of a member's value.
  JsonWriter& key(std::string_view name);

  /// UTF-8; bytes that are none become U+FFFD.
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(bool v) { return raw(v ? "true" : "false"); }
  /// Up to 2^63 - 1.
  template <std::integral T>
  JsonWriter& value(T v) {
    return separate(), out_.integer(static_cast<std::int64_t>(v)), *this;
  }
  /// With so many significant digits.
  JsonWriter& value(double v, int digits = 6);
  /// With so many decimals.
  JsonWriter& fixed(double v, int decimals);
  /// Lists as arrays; nil and numbers that are not finite as null.
  template <std::same_as<Value> V>
  JsonWriter& value(const V& v) {
    return anyValue(v);
  }
  JsonWriter& null() { return raw("null"); }
  /// A value that is JSON already.
  JsonWriter& raw(std::string_view json);

  template <class T>
  JsonWriter& member(std::string_view name, const T& v) {
    return key(name).value(v);
  }
  /// The members of an object that is JSON already, `{...}`, within the object that is open.
  JsonWriter& members(std::string_view object);
  /// An array of numbers.
  template <class List>
  JsonWriter& numbers(const List& list) {
    beginArray();
    for (const auto v : list) value(v);
    return endArray();
  }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  /// The comma between two values.
  void separate() {
    if (comma_) out_.put(',');
    comma_ = true;
  }
  void quote(std::string_view text);
  JsonWriter& anyValue(const Value& v);

  ByteWriter out_;
  JsonStyle style_;
  int depth_ = 0;       ///< brackets that are open
  bool comma_ = false;  ///< a value has been written that the next one follows
};

}  // namespace spark
