#include "print.h"

#include <fmt/format.h>

namespace sparkctl {

namespace {
constexpr std::size_t kMaxSiblings = 4;  // of one class in a row that are shown; longer runs are counted
constexpr std::size_t kDocColumn = 44;   // where documentation begins

std::string text(const Json& j, const char* key) { return j.value(key, std::string()); }

/// Number of UTF-8 characters.
std::size_t width(const std::string& s) {
  std::size_t n = 0;
  for (const char c : s) n += (c & 0xc0) != 0x80;
  return n;
}

std::string nodeLine(const std::string& indent, const std::string& name, const Json& node) {
  std::string left = indent + name;
  if (text(node, "class") == "Node") return left + "\n";  // a folder
  if (text(node, "class") != name) left += "  (" + text(node, "class") + ")";
  if (const std::string doc = text(node, "doc"); !doc.empty()) {
    const std::size_t w = width(left);
    left += std::string(w < kDocColumn ? kDocColumn - w : 2, ' ') + doc;
  }
  return left + "\n";
}

void children(const Json& node, const std::string& indent, bool all, std::string& out);

void child(const Json& node, const std::string& indent, bool last, bool all, std::string& out) {
  out += nodeLine(indent + (last ? "└─ " : "├─ "), text(node, "name"), node);
  children(node, indent + (last ? "   " : "│  "), all, out);
}

/// A line for each link of a node.
void links(const Json& node, const std::string& indent, std::string& out) {
  for (const Json& link : node.value("links", Json::array())) {
    std::string paths;
    for (const Json& path : link["paths"]) paths += (paths.empty() ? "" : ", ") + path.get<std::string>();
    out += fmt::format("{}   {}: {}\n", indent, text(link, "to"), paths.empty() ? "none" : paths);
  }
}

void children(const Json& node, const std::string& indent, bool all, std::string& out) {
  links(node, indent, out);
  if (node.contains("more")) out += fmt::format("{}└─ … {} below\n", indent, node["more"].get<std::size_t>());
  if (!node.contains("children")) return;
  const Json& list = node["children"];
  for (std::size_t i = 0; i < list.size();) {
    std::size_t run = i;
    while (run < list.size() && list[run]["class"] == list[i]["class"]) ++run;
    const std::size_t shown = all || run - i <= kMaxSiblings ? run : i + 1;
    for (std::size_t k = i; k < shown; ++k) child(list[k], indent, k + 1 == list.size(), all, out);
    if (shown < run)
      out += fmt::format("{}{}… {} more of class {}\n", indent, run == list.size() ? "└─ " : "├─ ", run - shown,
                         text(list[i], "class"));
    i = run;
  }
}

std::string range(const Json& p) {
  if (p.contains("choices")) {
    std::string out = ", one of";
    for (const Json& c : p["choices"]) out += " " + c.get<std::string>();
    return out;
  }
  std::string out;
  if (p.contains("min")) out += fmt::format(", from {:g}", p["min"].get<double>());
  if (p.contains("max")) out += fmt::format(", up to {:g}", p["max"].get<double>());
  return out;
}
}  // namespace

std::string treeText(const Json& node, const std::string& path, bool all) {
  std::string out = nodeLine("", path, node);
  children(node, "", all, out);
  return out;
}

std::string propertyText(const Json& p) {
  const std::string unit = text(p, "unit");
  return fmt::format("{} = {}{}\n    {}{}{}. {}\n", text(p, "name"), text(p, "text"), unit.empty() ? "" : " " + unit,
                     text(p, "type"), range(p), p.value("readOnly", false) ? ", read only" : "", text(p, "doc"));
}

std::string answerText(const Json& answer) {
  std::string out;
  for (const auto& [name, value] : answer.items()) {
    if (name == "ok") continue;
    out += fmt::format("{}\n  {}: ", out.empty() ? "{" : ",", Json(name).dump());
    if (!value.is_array() || value.empty()) {
      out += value.dump();
      continue;
    }
    for (const Json& element : value)
      out += fmt::format("{}\n    {}", &element == &value.front() ? "[" : ",", element.dump());
    out += "\n  ]";
  }
  return out.empty() ? "{}\n" : out + "\n}\n";
}

std::string pluginsText(const Json& plugins) {
  std::string out;
  for (const Json& p : plugins)
    out += fmt::format("{} {:<16} {:<6} {}\n", p.value("registered", false) ? "*" : " ", text(p, "name"),
                       text(p, "version"), text(p, "doc"));
  return out + "* registered by the config\n";
}

}  // namespace sparkctl
