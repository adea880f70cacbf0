#include "describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "spark/error.h"

namespace sparkhost {

using namespace spark;

namespace {
/// Registers a class's plugin and those of its bases.
ClassObject& load(Kernel& kernel, std::string_view className) {
  if (!kernel.findClass(className))
    if (Plugin* p = kernel.plugins().providerOf(className)) kernel.plugins().use(p->name());
  ClassObject& c = kernel.classOf(className);
  if (!c.baseName().empty()) load(kernel, c.baseName());
  return c;
}

std::string range(const Property& p) {
  if (!p.choices.empty()) return fmt::format(", one of {}", fmt::join(p.choices, " | "));
  if (p.min && p.max) return fmt::format(", {:g} .. {:g}", *p.min, *p.max);
  if (p.min) return fmt::format(", from {:g}", *p.min);
  if (p.max) return fmt::format(", up to {:g}", *p.max);
  return "";
}

std::string propertyLine(ClassObject& owner, const Property& p) {
  std::string type = p.type;
  if (!p.unit.empty() && type.find('[') == std::string::npos) type += " [" + p.unit + "]";
  type += range(p);
  if (p.readOnly)
    type += ", read only";
  else if (!owner.isAbstract())
    type += ", default " + owner.defaultOf(p).text();
  if (p.state) type += ", state";
  return fmt::format("    {:<22} {}\n{:27}{}\n", p.name, type, "", p.doc);
}

/// True for setX and getX of a property x.
bool isAccessor(ClassObject& c, const std::string& method) {
  if (method.size() < 4 || (method.compare(0, 3, "set") != 0 && method.compare(0, 3, "get") != 0)) return false;
  std::string property = method.substr(3);
  property[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(property[0])));
  return c.property(property) != nullptr;
}

std::string methodLine(const Method& m) {
  std::string signature = fmt::format("{}({})", m.name, fmt::join(m.parameters, ", "));
  if (!m.returns.empty() && m.returns.front() != '@') signature += " -> " + m.returns;
  return fmt::format("    {}\n{:27}{}\n", signature, "", m.doc);
}

std::string linkLines(ClassObject& c) {
  std::string out;
  for (const LinkDescription* link : c.links())
    out += fmt::format("    {}{}{}{}\n", link->all ? "all of: " : "", link->route.text(),
                       link->lacks.empty() ? "" : ", needed", link->doc.empty() ? "" : ": " + link->doc);
  return out.empty() ? out : "  looks up:\n" + out;
}

/// The entries of `all` that are not inherited unchanged.
template <class T>
std::vector<const T*> added(const std::vector<const T*>& all, const std::vector<const T*>& inherited) {
  std::vector<const T*> out;
  for (const T* t : all)
    if (std::find(inherited.begin(), inherited.end(), t) == inherited.end()) out.push_back(t);
  return out;
}

/// One section per class of the inheritance chain, the most derived first. A name that a derived class overrides is not
/// repeated.
template <class T, class Print>
std::string sections(ClassObject& c, const char* title, std::vector<const T*> (ClassObject::*list)(), Print print) {
  std::string out;
  std::set<std::string> seen;
  for (ClassObject* at = &c; at; at = at->base()) {
    ClassObject* base = at->base();
    std::string lines;
    for (const T* t : added((at->*list)(), base ? (base->*list)() : std::vector<const T*>{}))
      if (seen.insert(t->name).second) lines += print(*t);
    if (!lines.empty()) out += fmt::format("\n  {}{}\n{}", title, at == &c ? "" : " from " + at->name(), lines);
  }
  return out;
}
}  // namespace

std::string pluginList(Kernel& kernel) {
  std::vector<Plugin*> plugins;
  kernel.root().require<Node>("/plugins").collect(plugins);
  std::sort(plugins.begin(), plugins.end(), [](Plugin* a, Plugin* b) { return a->name() < b->name(); });
  std::string out;
  for (Plugin* p : plugins)
    out += fmt::format("{} {}\n    {}\n    {}\n    classes: {}\n", p->name(), p->version(), p->doc(), p->file(),
                       fmt::join(p->classes(), ", "));
  return out;
}

std::string classDescription(Kernel& kernel, std::string_view className) {
  ClassObject& c = load(kernel, className);
  std::string chain = c.name();
  std::string interfaces;
  for (ClassObject* at = &c; at; at = at->base()) {
    if (at != &c) chain += " < " + at->name();
    for (const auto& i : at->interfaces())
      if (i.id.name != at->name())
        interfaces += fmt::format("{}{} {}", interfaces.empty() ? "" : ", ", i.id.name, i.id.version);
  }
  std::string out = fmt::format("{}{}\n  {}\n", chain, c.isAbstract() ? " (abstract)" : "", c.doc());
  out += fmt::format(
      "  plugin: {}\n",
      c.plugin() ? c.plugin()->name() + " " + c.plugin()->version() + ", " + c.plugin()->file() : "the kernel");
  if (!interfaces.empty()) out += fmt::format("  interfaces: {}\n", interfaces);
  std::string phases;
  for (const Hook* h : c.hooks()) phases += (phases.empty() ? "" : ", ") + h->channel;
  if (!phases.empty()) out += fmt::format("  handles: {}\n", phases);
  out += linkLines(c);
  out += sections<Property>(c, "properties", &ClassObject::properties,
                            [&](const Property& p) { return propertyLine(c, p); });
  out += sections<Method>(c, "methods", &ClassObject::methods,
                          [&](const Method& m) { return isAccessor(c, m.name) ? std::string() : methodLine(m); });
  return out + "\n  Every property x also has the methods getX and, unless it is read only, setX.\n";
}

}  // namespace sparkhost
