// Predicates as values and back.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "spark/predicates.h"
#include "spark/state_stream.h"

namespace spark {

namespace {
Value toValue(const Element& e) {
  const Token& t = e.token();
  switch (t.kind) {
    case Token::Kind::number:
      return t.number;
    case Token::Kind::integer:
      return t.integer;
    case Token::Kind::text:
      return e.text();
    case Token::Kind::list:
      break;
  }
  List out;
  for (const Element inner : e) out.push_back(toValue(inner));
  return out;
}

void appendValue(const Value& v, Predicates& out) {
  switch (v.type()) {
    case Value::Type::number:
      out.add(v.toNumber());
      return;
    case Value::Type::integer:
      out.add(v.toInteger());
      return;
    case Value::Type::string:
      out.add(v.toString(), !isWord(v.toString()));
      return;
    case Value::Type::nil:
    case Value::Type::boolean:
      out.add(v.text());
      return;
    case Value::Type::list:
      break;
  }
  out.open();
  append(v.toList(), out);
  out.close();
}

void writeType(Value::Type type, StateWriter& out) { out.write(static_cast<std::int64_t>(type)); }

/// Writes a list as StateWriter writes a value of that type. A text in quotes is the list of nil, which no other
/// element is, and the text.
template <class Range>
void saveList(const Range& elements, StateWriter& out) {
  std::int64_t size = 0;
  for ([[maybe_unused]] const Element e : elements) ++size;
  writeType(Value::Type::list, out);
  out.write(size);
  for (const Element e : elements) {
    const Token& t = e.token();
    switch (t.kind) {
      case Token::Kind::number:
        writeType(Value::Type::number, out);
        out.write(t.number);
        break;
      case Token::Kind::integer:
        writeType(Value::Type::integer, out);
        out.write(t.integer);
        break;
      case Token::Kind::text:
        if (t.quoted) {
          writeType(Value::Type::list, out);
          out.write(std::int64_t{2});
          writeType(Value::Type::nil, out);
        }
        writeType(Value::Type::string, out);
        out.write(e.text());
        break;
      case Token::Kind::list:
        saveList(e, out);
    }
  }
}

void loadList(const List& saved, Predicates& to) {
  for (const Value& v : saved) {
    if (v.isString()) {
      to.add(v.toString());
    } else if (!v.isList()) {
      appendValue(v, to);
    } else if (const List& inner = v.toList(); inner.size() == 2 && inner[0].isNil()) {
      to.add(inner[1].toString(), true);
    } else {
      to.open();
      loadList(inner, to);
      to.close();
    }
  }
}
}  // namespace

List toList(const Predicates& predicates) {
  List out;
  for (const Element e : predicates) out.push_back(toValue(e));
  return out;
}

void append(const List& values, Predicates& out) {
  for (const Value& v : values) appendValue(v, out);
}

void savePredicates(const Predicates& predicates, StateWriter& out) { saveList(predicates, out); }

void loadPredicates(StateReader& in, Predicates& to) {
  to.clear();
  loadList(in.readValue().toList(), to);
}

bool isWord(std::string_view text) {
  const auto fits = [](unsigned char c) { return c > ' ' && c != 0x7f && !std::strchr("()\"'\\;", c); };
  return !text.empty() && std::all_of(text.begin(), text.end(), fits);
}

std::string whyUnwritable(const Value& value) {
  if (value.isList()) {
    for (const Value& v : value.toList())
      if (std::string why = whyUnwritable(v); !why.empty()) return why;
  } else if (value.isString() && !isWord(value.toString())) {
    return "expected text of one word without blanks, brackets and quotes, found " + value.text();
  } else if (value.isNil() || (value.isNumber() && !std::isfinite(value.toNumber()))) {
    return "expected a finite number, a word, a bool, or a list of these, found " + value.text();
  }
  return {};
}

}  // namespace spark
