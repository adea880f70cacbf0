// What a class object says about its class to scripts and tools, as values.
#include <algorithm>

#include "spark/class_object.h"

namespace spark {

namespace {
/// Adds a field to a table, unless its value is nil or an empty text.
void addField(List& table, const char* name, Value value) {
  if (value.isNil() || value == Value("")) return;
  table.push_back(List{name, std::move(value)});
}

Value numberOrNil(const std::optional<double>& number) { return number ? Value(*number) : Value(); }

Value listOrNil(const std::vector<std::string>& texts) {
  return texts.empty() ? Value() : Convert<std::vector<std::string>>::to(texts);
}

List tableOf(const Property& p) {
  List out;
  addField(out, "name", p.name);
  addField(out, "type", p.type);
  addField(out, "unit", p.unit);
  addField(out, "doc", p.doc);
  addField(out, "readOnly", p.readOnly);
  addField(out, "state", p.state);
  addField(out, "min", numberOrNil(p.min));
  addField(out, "max", numberOrNil(p.max));
  addField(out, "choices", listOrNil(p.choices));
  return out;
}

/// `called`: the method itself, which an alias only names.
List tableOf(const Method& m, const Method& called) {
  List out;
  addField(out, "name", m.name);
  addField(out, "doc", m.doc);
  out.push_back(List{"parameters", Convert<std::vector<std::string>>::to(called.parameters)});
  addField(out, "returns", called.returns);
  return out;
}
}  // namespace

std::vector<std::string> ClassObject::interfaceNames() {
  std::vector<std::string> out;
  if (ClassObject* b = base()) out = b->interfaceNames();
  for (const auto& i : interfaces())
    if (i.id.name != name() && std::find(out.begin(), out.end(), i.id.name) == out.end()) out.emplace_back(i.id.name);
  return out;
}

TableValue ClassObject::propertyTables() {
  const auto fresh = isAbstract() ? nullptr : create();
  List out;
  for (const Property* p : properties()) {
    List table = tableOf(*p);
    if (fresh) addField(table, "default", p->get(*fresh));
    out.push_back(std::move(table));
  }
  return {std::move(out)};
}

TableValue ClassObject::methodTables() {
  List out;
  for (const Method* m : methods()) out.push_back(tableOf(*m, *method(m->name)));
  return {std::move(out)};
}

}  // namespace spark
