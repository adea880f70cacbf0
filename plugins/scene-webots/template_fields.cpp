#include "template_fields.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace spark::webots {

using nlohmann::json;

namespace {

constexpr int kDeepest = 50;  ///< of nodes in nodes

/// The keys of one value of some numbers; none for a plain number.
std::vector<const char*> keysOf(std::string_view type, std::size_t numbers) {
  if (type == "Vec2f") return {"x", "y"};
  if (type == "Vec3f") return {"x", "y", "z"};
  if (type == "Color") return {"r", "g", "b"};
  if (type == "Rotation") return {"x", "y", "z", "a"};
  if (!type.empty()) return {};
  if (numbers == 2) return {"x", "y"};
  if (numbers == 4) return {"x", "y", "z", "a"};
  return {};
}

json numbersFor(const double* numbers, const std::vector<const char*>& keys) {
  json out = json::object();
  for (std::size_t i = 0; i < keys.size(); ++i) out[keys[i]] = numbers[i];
  return out;
}

json oneFor(const Value& v, std::string_view type) {
  const std::vector<const char*> keys = keysOf(type, v.numbers.size());
  if (!keys.empty()) return keys.size() <= v.numbers.size() ? numbersFor(v.numbers.data(), keys) : json();
  // Of a node: a vector or a colour.
  if (type.empty() && v.numbers.size() == 3)
    return numbersFor(
        std::array{v.numbers[0], v.numbers[1], v.numbers[2], v.numbers[0], v.numbers[1], v.numbers[2]}.data(),
        {"x", "y", "z", "r", "g", "b"});
  return v.numbers.front();
}

/// `name`: of a node's field.
json listFor(const Value& v, std::string_view type, std::string_view name) {
  if (type.empty() && (name == "point" || name == "vector")) type = "Vec3f";
  if (type.empty() && name == "color") type = "Color";
  const std::vector<const char*> keys = type.empty() ? std::vector<const char*>{} : keysOf(type, 0);
  json out = json::array();
  const std::size_t step = std::max<std::size_t>(keys.size(), 1);
  for (std::size_t i = 0; i + step <= v.numbers.size(); i += step)
    out.push_back(keys.empty() ? json(v.numbers[i]) : numbersFor(v.numbers.data() + i, keys));
  return out;
}

json valueOf(const Value& v, std::string_view type, std::string_view name, int depth);

json nodeFor(const Node& node, int depth) {
  const Node& shown = node.origin ? *node.origin : node;
  json fields = json::object();
  if (depth < kDeepest)
    for (const Field& f : shown.fields) fields[f.name] = {{"value", valueOf(*f.value, "", f.name, depth + 1)}};
  return {{"node_name", shown.type}, {"fields", std::move(fields)}};
}

json wordFor(const std::string& word) { return word == "NULL" ? json() : json(word == "TRUE"); }

json valueOf(const Value& v, std::string_view type, std::string_view name, int depth) {
  const bool list = type.starts_with("MF") || (type.empty() && v.isList);
  const std::string_view element = type.empty() ? type : type.substr(2);
  json out = json::array();
  switch (v.kind) {
    case Value::Kind::numbers:
      return list ? listFor(v, element, name) : oneFor(v, element);
    case Value::Kind::texts:
      if (!list) return v.texts.front();
      for (const std::string& text : v.texts) out.push_back(text);
      return out;
    case Value::Kind::words:
      if (!list) return wordFor(v.texts.front());
      for (const std::string& word : v.texts) out.push_back(wordFor(word));
      return out;
    case Value::Kind::nodes:
      if (!list) return nodeFor(*v.nodes.front(), depth);
      for (const NodePtr& node : v.nodes) out.push_back(nodeFor(*node, depth));
      return out;
    default:
      return list ? out : json();
  }
}

}  // namespace

json valueFor(const Value& value, std::string_view type) { return valueOf(value, type, "", 0); }

}  // namespace spark::webots
