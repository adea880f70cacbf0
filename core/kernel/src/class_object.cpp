#include "spark/class_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "spark/error.h"
#include "spark/kernel.h"
#include "spark/running.h"
#include "tree.h"

namespace spark {

namespace {
/// The name of a generated method: "set" and "x" make "setX".
std::string accessorName(std::string_view prefix, std::string_view property) {
  std::string out(prefix);
  out += property;
  if (char& c = out[prefix.size()]; c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return out;
}

/// The class with the plugin that provides it, for messages.
std::string classAndPlugin(const ClassObject& c) {
  return c.plugin() ? fmt::format("class {} of plugin {}", c.name(), c.plugin()->name())
                    : fmt::format("class {}", c.name());
}

/// What a class inherits, and its own, which overrides entries of the same name.
template <class T>
std::vector<const T*> overridden(std::vector<const T*> all, const std::vector<T>& own) {
  for (const T& entry : own) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const T* other) { return other->name == entry.name; });
    if (same == all.end())
      all.push_back(&entry);
    else
      *same = &entry;
  }
  return all;
}
}  // namespace

std::unique_ptr<Leaf> makeAsBase() { return nullptr; }

ClassObject::ClassObject(Kernel& kernel, ClassDescription description, Plugin* plugin)
    : kernel_(kernel), description_(std::move(description)), plugin_(plugin) {
  setName(description_.name);
  // A property x makes the methods setX and getX, unless the class has methods of those names.
  const auto has = [&](const std::string& n) {
    return std::any_of(description_.methods.begin(), description_.methods.end(),
                       [&](const Method& m) { return m.name == n; });
  };
  std::vector<Method> generated;
  for (const Property& p : description_.properties) {
    if (!p.readOnly && !has(accessorName("set", p.name))) {
      Method m;
      m.name = accessorName("set", p.name);
      m.doc = fmt::format("Sets {}. {}", p.name, p.doc);
      m.parameters = {p.unit.empty() ? fmt::format("{}: {}", p.name, p.type)
                                     : fmt::format("{}: {} [{}]", p.name, p.type, p.unit)};
      m.minScalars = std::max(p.scalars, 0);
      m.maxScalars = p.scalars;
      m.call = [p](Leaf& l, Args& a) -> Value {
        writeProperty(p, l, a);
        return {};
      };
      generated.push_back(std::move(m));
    }
    if (!has(accessorName("get", p.name))) {
      Method m;
      m.name = accessorName("get", p.name);
      m.doc = fmt::format("Gives {}. {}", p.name, p.doc);
      m.returns = p.type;
      m.call = [get = p.get](Leaf& l, Args&) { return get(l); };
      generated.push_back(std::move(m));
    }
  }
  for (Method& m : generated) description_.methods.push_back(std::move(m));
  fillCasts();  // the class of classes is queried before it is resolved
}

ClassObject::~ClassObject() { detail::Tree::disown(*this); }

void ClassObject::describe(Description<ClassObject>& d) {
  d.doc("A class: makes objects and knows what they can do.");
  d.property("doc", &ClassObject::doc).doc("What the class is.");
  d.property("base", &ClassObject::baseName).doc("Name of the base class.");
  d.property("living", &ClassObject::livingCount).doc("Number of objects of exactly this class.");
  d.property("providedBy", &ClassObject::pluginName).doc("The plugin that registered it; empty for the kernel's own.");
  d.property("abstract", &ClassObject::isAbstract).doc("Only a base, without objects of its own.");
  d.method("isA", &ClassObject::isOrOffers)
      .parameters({"name"})
      .doc("Whether that is its name, or the name of one of its bases or interfaces.");
  d.method("interfaces", &ClassObject::interfaceNames).doc("Names of all its interfaces, those of bases first.");
  d.method("properties", &ClassObject::propertyTables)
      .doc(
          "A table for each property, those of bases first: name, type, doc, readOnly, state, and where they exist "
          "unit, min, max, choices and default.");
  d.method("methods", &ClassObject::methodTables)
      .doc("A table for each method, those of bases first: name, doc, parameters (\"name: type [unit]\"), returns.");
}

std::int64_t ClassObject::livingCount() const { return static_cast<std::int64_t>(living_); }
std::string ClassObject::pluginName() const { return plugin_ ? plugin_->name() : std::string(); }

ClassObject* ClassObject::base() {
  if (!base_ && !description_.base.empty()) base_ = kernel_.findClass(description_.base);
  return base_;
}

/// Fills the lists that contain inherited entries. Later than the constructor, because bases may be registered after
/// derived classes. Throws Error if a base is not registered.
void ClassObject::resolve() {
  if (resolved_) return;
  if (ClassObject* b = base()) {
    hooks_ = b->hooks();
    links_ = b->links();
  } else if (!description_.base.empty()) {
    const Plugin* provider = kernel_.plugins().providerOf(description_.base);
    throw Error(fmt::format(
        "{} needs its base class {}, which is not registered. {}", classAndPlugin(*this), description_.base,
        provider ? fmt::format("Plugin '{0}' provides it: add plugin \"{0}\" to the config.", provider->name())
                 : "No scanned plugin provides it."));
  }
  for (const Hook& h : description_.hooks) hooks_.push_back(&h);
  for (const LinkDescription& l : description_.links) links_.push_back(&l);
  for (const LinkDescription* l : links_) sites_.push_back({&kernel_.structureVersion(), &l->route});
  for (const Property* p : properties())
    if (p->state) stateProperties_.push_back(p);
  fillCasts();
  resolved_ = true;
}

/// Runs the constructor.
std::unique_ptr<Leaf> ClassObject::construct() const {
  const NowRunning now("the constructor", this);
  const ClassObject* maker = this;
  while (maker->description_.make == makeAsBase) maker = maker->base_;
  try {
    return maker->description_.make();
  } catch (const std::exception& e) {
    throw Error(fmt::format("the constructor of {} failed", classAndPlugin(*this)), e);
  } catch (...) {
    throw Error(fmt::format("the constructor of {} failed: it threw something that is no std::exception",
                            classAndPlugin(*this)));
  }
}

std::unique_ptr<Leaf> ClassObject::create() {
  if (isAbstract()) throw Error(fmt::format("class {} is a base for others and cannot be made itself", name()));
  resolve();
  std::unique_ptr<Leaf> leaf = construct();
  kernel_.tree().adopt(*leaf, *this);
  ++living_;
  bindLinks(*leaf);
  return leaf;
}

/// Connects the links of a new object with their routes.
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

/// Logs the required links of `leaf` that have no target.
void ClassObject::warnOfMissing(const Leaf& leaf) const {
  for (const LinkDescription* l : links_)
    if (!l->lacks.empty() && !l->route.find(leaf))
      kernel_.log().warning("{}: expected {}, found none. {}", leaf.path(), l->route.text(), l->lacks);
}

bool ClassObject::isA(std::string_view className) {
  for (ClassObject* c = this; c; c = c->base())
    if (c->name() == className || c->baseName() == className) return true;
  return false;
}

bool ClassObject::isOrOffers(const std::string& name) {
  for (ClassObject* c = this; c; c = c->base())
    if (c->name() == name || c->baseName() == name ||
        std::any_of(c->interfaces().begin(), c->interfaces().end(), [&](const auto& i) { return i.id.name == name; }))
      return true;
  return false;
}

void ClassObject::fillCasts() {
  // The class's own interfaces are added first, so that a derived class overrides the casts of its bases.
  std::vector<Cast> all;
  for (const ClassObject* c = this; c; c = c->base_)
    for (const auto& i : c->description_.interfaces)
      if (std::none_of(all.begin(), all.end(), [&](const Cast& known) { return known.id == i.id.id; }))
        all.push_back({i.id.id, i.cast});
  // At most a quarter of the table is used; linear probing.
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
      if (m.name == name) return m.call ? &m : method(m.returns.substr(1));  // an alias returns "@name"
  return nullptr;
}

const Property* ClassObject::propertySetBy(std::string_view methodName) {
  for (ClassObject* c = this; c; c = c->base())
    for (const Property& p : c->description_.properties)
      if (methodName == accessorName("set", p.name)) return &p;
  return nullptr;
}

std::vector<const Property*> ClassObject::properties() {
  return overridden(base() ? base()->properties() : std::vector<const Property*>(), description_.properties);
}

std::vector<const Method*> ClassObject::methods() {
  return overridden(base() ? base()->methods() : std::vector<const Method*>(), description_.methods);
}

const std::vector<const Hook*>& ClassObject::hooks() { return resolve(), hooks_; }
const std::vector<const LinkDescription*>& ClassObject::links() { return resolve(), links_; }
const std::vector<const Property*>& ClassObject::stateProperties() { return resolve(), stateProperties_; }

Value ClassObject::defaultOf(const Property& property) { return isAbstract() ? Value() : property.get(*create()); }

}  // namespace spark
