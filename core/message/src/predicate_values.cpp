// Predicates as values and back.

#include "spark/predicates.h"

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
      out.add(v.toString());
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
}  // namespace

List toList(const Predicates& predicates) {
  List out;
  for (const Element e : predicates) out.push_back(toValue(e));
  return out;
}

void append(const List& values, Predicates& out) {
  for (const Value& v : values) appendValue(v, out);
}

}  // namespace spark
