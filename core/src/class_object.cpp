#include "spark/class_object.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/running.h"

namespace spark {

namespace {
std::string capitalised(std::string_view prefix, std::string_view name) {
  std::string out(prefix);
  out += name;
  if (char& c = out[prefix.size()]; c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return out;
}

/// Numbers may come as text: what will be read from it is checked.
void checkRange(const Property& p, const Value& v, bool loose) {
  if (!p.min && !p.max) return;
  if (v.isList()) {
    for (const Value& e : v.toList()) checkRange(p, e, loose);
  } else if (v.isNumber() || v.isString()) {
    Args args{std::span(&v, 1), loose};
    const double d = Convert<double>::from(args);
    if ((p.min && !(d >= *p.min)) || (p.max && !(d <= *p.max)))
      throw Error("expected " + (p.min ? Value(*p.min).text() : std::string("-inf")) + " to " +
                  (p.max ? Value(*p.max).text() : std::string("inf")) + (p.unit.empty() ? "" : " " + p.unit) +
                  ", found " + v.text());
  }
}

void checkChoices(const Property& p, const Value& v) {
  if (p.choices.empty()) return;
  if (std::find(p.choices.begin(), p.choices.end(), v.plain()) != p.choices.end()) return;
  std::string all;
  for (const std::string& c : p.choices) all += (all.empty() ? "'" : ", '") + c + "'";
  throw Error("expected one of " + all + ", found " + v.text());
}

/// The type in `name: type [unit]`, of which only the type must be there.
std::string_view typeOf(std::string_view parameter) {
  if (const std::size_t colon = parameter.find(": "); colon != std::string_view::npos)
    parameter.remove_prefix(colon + 2);
  return parameter.substr(0, parameter.find(" ["));
}

/// What typed texts among the arguments mean for the method.
std::vector<Value> readTyped(const Method& m, std::span<const Value> arguments) {
  constexpr std::string_view kListOf = "list of ";
  const bool each = arguments.size() == m.parameters.size();
  std::string_view type;  // of plain arguments that together make a vector: none of its own
  if (!each && m.parameters.size() == 1 && typeOf(m.parameters[0]).starts_with(kListOf))
    type = typeOf(m.parameters[0]).substr(kListOf.size());
  std::vector<Value> out;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    out.push_back(arguments[i].readAs(each ? typeOf(m.parameters[i]) : type));
  return out;
}

void write(const Property& p, Leaf& leaf, Args& args) {
  for (const Value& v : args.values) {
    checkRange(p, v, args.loose);
    checkChoices(p, v);
  }
  p.set(leaf, args);
}
}  // namespace

ClassObject::ClassObject(ClassDescription description, Plugin* plugin)
    : description_(std::move(description)), plugin_(plugin) {
  setName(description_.name);
  // A property x gives setX and getX, unless the class has methods of those names.
  const auto has = [&](const std::string& n) {
    return std::any_of(description_.methods.begin(), description_.methods.end(),
                       [&](const Method& m) { return m.name == n; });
  };
  std::vector<Method> generated;
  for (const Property& p : description_.properties) {
    const int scalars = p.scalars;
    if (!p.readOnly && !has(capitalised("set", p.name))) {
      Method m;
      m.name = capitalised("set", p.name);
      m.doc = "Sets " + p.name + ". " + p.doc;
      m.parameters = {p.name + ": " + p.type + (p.unit.empty() ? "" : " [" + p.unit + "]")};
      m.minScalars = scalars < 0 ? 0 : scalars;
      m.maxScalars = scalars;
      m.call = [p](Leaf& l, Args& a) -> Value {
        write(p, l, a);
        return {};
      };
      generated.push_back(std::move(m));
    }
    if (!has(capitalised("get", p.name))) {
      Method m;
      m.name = capitalised("get", p.name);
      m.doc = "Gives " + p.name + ". " + p.doc;
      m.returns = p.type;
      m.call = [get = p.get](Leaf& l, Args&) { return get(l); };
      generated.push_back(std::move(m));
    }
  }
  for (Method& m : generated) description_.methods.push_back(std::move(m));
  fillCasts();  // class objects are queried before they are resolved
}

ClassObject::~ClassObject() { class_ = nullptr; }

void ClassObject::describe(Description<ClassObject>& d) {
  d.doc("A class: makes objects and knows what they can do.");
  d.property("doc", &ClassObject::doc).doc("What the class is.");
  d.property("base", &ClassObject::baseName).doc("Name of the base class.");
  d.property("living", &ClassObject::livingCount).doc("Number of objects of exactly this class.");
  d.property("providedBy", &ClassObject::pluginName).doc("The plugin that registered it; empty for the kernel's own.");
}

std::int64_t ClassObject::livingCount() const { return static_cast<std::int64_t>(living_); }
std::string ClassObject::pluginName() const { return plugin_ ? plugin_->name() : std::string(); }

ClassObject* ClassObject::base() {
  if (base_ || description_.base.empty()) return base_;
  base_ = kernel().findClass(description_.base);
  if (!base_) {
    Plugin* provider = kernel().plugins().providerOf(description_.base);
    throw Error("class " + name() + (plugin_ ? " of plugin " + plugin_->name() : "") + " needs its base class " +
                description_.base + ", which is not registered. " +
                (provider ? "Plugin '" + provider->name() + "' provides it: add plugin \"" + provider->name() +
                                "\" to the config."
                          : "No scanned plugin provides it."));
  }
  return base_;
}

void ClassObject::resolve() {
  if (resolved_) return;
  if (ClassObject* b = base()) {
    hooks_ = b->hooks();
    links_ = b->links();
  }
  for (const Hook& h : description_.hooks) hooks_.push_back(&h);
  for (const LinkDescription& l : description_.links) links_.push_back(&l);
  for (const LinkDescription* l : links_) sites_.push_back({&kernel().structureVersion(), &l->route});
  for (const Property* p : properties())
    if (p->state) stateProperties_.push_back(p);
  fillCasts();
  resolved_ = true;
}

/// Runs the constructor, which knows neither class nor place.
std::unique_ptr<Leaf> ClassObject::construct() const {
  const NowRunning now("the constructor", this);
  const auto failed = [this] {
    return "the constructor of class " + name() + (plugin_ ? " of plugin " + plugin_->name() : "") + " failed";
  };
  try {
    return description_.make();
  } catch (const std::exception& e) {
    throw Error(failed(), e);
  } catch (...) {
    throw Error(failed() + ": it threw something that is no std::exception");
  }
}

std::unique_ptr<Leaf> ClassObject::create() {
  if (isAbstract()) throw Error("class " + name() + " is a base for others and cannot be made itself");
  resolve();
  std::unique_ptr<Leaf> leaf = construct();
  leaf->class_ = this;
  leaf->id_ = kernel().nextId_++;
  ++living_;
  if (leaf->name_.empty()) leaf->name_ = name();
  bindLinks(*leaf);
  return leaf;
}

void ClassObject::bindLinks(Leaf& leaf) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    detail::LinkBase& link = links_[i]->member(leaf);
    sites_[i].offset = reinterpret_cast<const char*>(&link) - reinterpret_cast<const char*>(&leaf);
    link.bind(sites_[i]);
  }
}

std::vector<Found<void>> LinkDescription::targets(const Leaf& owner) const {
  std::vector<Found<void>> out;
  if (all)
    route.findAll(owner, out);
  else if (const Found<void> found = route.find(owner))
    out.push_back(found);
  return out;
}

void ClassObject::warnOfMissing(const Leaf& leaf) const {
  for (const LinkDescription* l : links_)
    if (!l->lacks.empty() && !l->route.find(leaf))
      kernel().log().warning("{}: expected {}, found none. {}", leaf.path(), l->route.text(), l->lacks);
}

bool ClassObject::isA(std::string_view className) {
  for (ClassObject* c = this; c; c = c->base())
    if (c->name() == className) return true;
  return false;
}

void ClassObject::fillCasts() {
  std::vector<Cast> all;
  for (const ClassObject* c = this; c; c = c->base_)
    for (const auto& i : c->description_.interfaces)
      if (std::none_of(all.begin(), all.end(), [&](const Cast& known) { return known.id == i.id.id; }))
        all.push_back({i.id.id, i.cast});
  castMask_ = std::bit_ceil(4 * all.size() + 1) - 1;
  casts_.assign(castMask_ + 1, Cast{});
  for (const Cast& cast : all) {
    std::size_t i = cast.id & castMask_;
    while (casts_[i].id) i = (i + 1) & castMask_;
    casts_[i] = cast;
  }
}

const Property* ClassObject::property(std::string_view name) {
  for (ClassObject* c = this; c; c = c->base())
    for (const Property& p : c->description_.properties)
      if (p.name == name) return &p;
  return nullptr;
}

const Method* ClassObject::method(std::string_view name) {
  for (ClassObject* c = this; c; c = c->base())
    for (const Method& m : c->description_.methods)
      if (m.name == name) return m.call ? &m : method(m.returns.substr(1));
  return nullptr;
}

std::vector<const Property*> ClassObject::properties() {
  std::vector<const Property*> out;
  if (ClassObject* b = base()) out = b->properties();
  for (const Property& p : description_.properties) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Property* q) { return q->name == p.name; });
    if (same == out.end())
      out.push_back(&p);
    else
      *same = &p;
  }
  return out;
}

std::vector<const Method*> ClassObject::methods() {
  std::vector<const Method*> out;
  if (ClassObject* b = base()) out = b->methods();
  for (const Method& m : description_.methods) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Method* q) { return q->name == m.name; });
    if (same == out.end())
      out.push_back(&m);
    else
      *same = &m;
  }
  return out;
}

const std::vector<const Hook*>& ClassObject::hooks() {
  resolve();
  return hooks_;
}

const std::vector<const LinkDescription*>& ClassObject::links() {
  resolve();
  return links_;
}

const std::vector<const Property*>& ClassObject::stateProperties() {
  resolve();
  return stateProperties_;
}

Value ClassObject::defaultOf(const Property& property) {
  if (isAbstract()) return {};
  const auto fresh = create();
  return property.get(*fresh);
}

namespace {
ClassObject& classFor(const Leaf& leaf) {
  if (!leaf.classObject()) throw Error(leaf.path() + " has no class");
  return *leaf.classObject();
}

const Property& findProperty(const Leaf& leaf, std::string_view name) {
  ClassObject& c = classFor(leaf);
  if (const Property* p = c.property(name)) return *p;
  std::vector<std::string> names;
  for (const Property* p : c.properties()) names.push_back(p->name);
  throw Error(leaf.path() + " (class " + c.name() + ") has no property '" + std::string(name) + "'." +
              didYouMean(name, names));
}

std::string signature(const Method& m) {
  std::string out = m.name + "(";
  for (const std::string& p : m.parameters) out += (out.back() == '(' ? "" : ", ") + p;
  return out + ")";
}

int scalarCount(std::span<const Value> arguments) {
  int n = 0;
  for (const Value& v : arguments) n += v.isList() ? static_cast<int>(v.toList().size()) : 1;
  return n;
}

std::string countProblem(const Method& m, std::span<const Value> arguments, bool loose) {
  const int n = scalarCount(arguments);
  // One list may stand for one argument; only what is plainly too few or too many is refused here.
  const bool tooFew = n < m.minScalars && static_cast<int>(arguments.size()) < m.minScalars;
  const bool tooMany =
      m.maxScalars >= 0 && static_cast<int>(arguments.size()) > m.maxScalars && !(loose && m.surplusIgnored);
  if (!tooFew && !tooMany) return {};
  std::string wanted = std::to_string(m.minScalars);
  if (m.maxScalars < 0)
    wanted = "at least " + wanted;
  else if (m.maxScalars != m.minScalars)
    wanted += " to " + std::to_string(m.maxScalars);
  return signature(m) + " expected " + wanted + " arguments, found " + std::to_string(n);
}
/// What loose reading made of texts where numbers are due: " 'six' was read as 0.", "" when there are none.
std::string readAsNumbers(const Method& m, std::span<const Value> arguments) {
  const auto wantsNumbers = [](const std::string& parameter) {
    return parameter.find("number") != std::string::npos || parameter.find("integer") != std::string::npos ||
           parameter.find("vec3") != std::string::npos;
  };
  if (!std::all_of(m.parameters.begin(), m.parameters.end(), wantsNumbers)) return {};
  std::string out;
  for (const Value& v : arguments) {
    if (!v.isString()) continue;
    const char* text = v.toString().c_str();
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    if (end == text || *end != 0)
      out += "\n  '" + v.toString() + "' is no number: it was read as " + Value(number).text() + ".";
  }
  return out;
}
}  // namespace

Value getProperty(const Leaf& leaf, std::string_view name) { return findProperty(leaf, name).get(leaf); }

void setProperty(Leaf& leaf, std::string_view name, const Value& value) {
  const Property& p = findProperty(leaf, name);
  if (!p.set) throw Error(leaf.path() + "." + std::string(name) + " is read only");
  const NowRunning now(p.name.c_str(), &leaf);
  try {
    const Value meant = value.readAs(p.type);
    Args args{std::span(&meant, 1)};
    write(p, leaf, args);
  } catch (const std::exception& e) {
    throw Error("cannot set " + leaf.path() + "." + std::string(name), e);
  }
}

Value callMethod(Leaf& leaf, std::string_view name, std::span<const Value> arguments) {
  ClassObject& c = classFor(leaf);
  const Method* m = c.method(name);
  if (!m) {
    std::vector<std::string> names;
    for (const Method* q : c.methods()) names.push_back(q->name);
    throw Error(leaf.path() + " (class " + c.name() + ") has no method '" + std::string(name) + "'." +
                didYouMean(name, names));
  }
  if (const std::string problem = countProblem(*m, arguments, false); !problem.empty())
    throw Error("cannot call " + leaf.path() + ": " + problem);
  const NowRunning now(m->name.c_str(), &leaf);
  try {
    std::vector<Value> meant;
    if (std::any_of(arguments.begin(), arguments.end(), [](const Value& v) { return v.isTyped(); }))
      arguments = meant = readTyped(*m, arguments);
    Args args{arguments};
    Value result = m->call(leaf, args);
    if (!args.atEnd())
      throw Error(signature(*m) + " expected fewer arguments, found " + std::to_string(arguments.size()));
    return result;
  } catch (const std::exception& e) {
    throw Error("cannot call " + std::string(name) + " of " + leaf.path(), e);
  }
}

bool callLoosely(Leaf& leaf, const Method& method, std::span<const Value> arguments, std::string& whyNot) {
  whyNot = countProblem(method, arguments, true);
  if (!whyNot.empty()) return false;
  const NowRunning now(method.name.c_str(), &leaf);
  try {
    Args args{arguments, true};
    method.call(leaf, args);
    return true;
  } catch (const RefusedValue&) {
    throw;
  } catch (const std::exception& e) {
    whyNot = signature(method) + ": " + e.what() + readAsNumbers(method, arguments);
    return false;
  }
}

}  // namespace spark
