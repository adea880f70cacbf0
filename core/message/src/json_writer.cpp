#include "spark/json_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace spark {

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  out_.put(bracket);
  comma_ = false;
  ++depth_;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  out_.put(bracket);
  comma_ = true;
  if (--depth_ == 0) out_.flush();
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  quote(name);
  out_.put(':');
  comma_ = false;
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  quote(text);
  return *this;
}

JsonWriter& JsonWriter::value(double v, int digits) {
  if (!std::isfinite(v)) return raw(style_.notFinite);
  separate();
  if (digits == 6)
    out_.general(v);
  else
    out_.put(fmt::format("{:.{}g}", v, digits));
  return *this;
}

JsonWriter& JsonWriter::fixed(double v, int decimals) {
  if (!std::isfinite(v)) return raw(style_.notFinite);
  separate();
  out_.end(putFixed(out_.room(kFixedRoom), v, decimals, kAllDouble));
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view json) {
  separate();
  out_.put(json);
  return *this;
}

JsonWriter& JsonWriter::members(std::string_view object) {
  // Without its braces, the text is written like one value. "{}" has no members.
  if (object.size() > 2) raw(object.substr(1, object.size() - 2));
  return *this;
}

void JsonWriter::quote(std::string_view text) {
  // Nearly all strings need no escapes; the library writes the others.
  const auto plain = [](unsigned char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; };
  if (!std::all_of(text.begin(), text.end(), plain))
    return out_.put(nlohmann::json(text).dump(-1, ' ', style_.ascii, nlohmann::json::error_handler_t::replace));
  out_.put('"');
  out_.put(text);
  out_.put('"');
}

JsonWriter& JsonWriter::anyValue(const Value& v) {
  if (v.isString()) return value(std::string_view(v.toString()));
  if (v.isNil() || (v.isNumber() && !std::isfinite(v.toNumber()))) return null();
  if (!v.isList()) return raw(v.plain());
  beginArray();
  for (const Value& part : v.toList()) anyValue(part);
  return endArray();
}

}  // namespace spark
