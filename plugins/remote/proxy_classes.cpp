#include "proxy_classes.h"

#include <fmt/format.h>

#include <algorithm>

#include "messages.h"
#include "remote_node.h"
#include "scene_feed.h"
#include "spark/class_description.h"
#include "wire.h"

namespace spark::remote {

namespace {
// Of all classes that a host describes, replaced ones among them.
constexpr std::size_t kMostClasses = 10'000, kMostBytes = 64 << 20;

/// All that is left, as one value: several plain arguments are the elements of a list.
Value rest(Args& args) {
  if (args.left() == 1) return args.take();
  List all;
  while (!args.atEnd()) all.push_back(args.take());
  return all;
}

List restAsList(Args& args) {
  List all;
  while (!args.atEnd()) all.push_back(args.take());
  return all;
}

/// `local`: the class of this host from which the class derives; nullptr: RemoteNode.
Property property(const List& from, ClassObject* local) {
  Property p;
  p.name = from.at(0).toString();
  p.type = from.at(1).toString();
  p.unit = from.at(2).toString();
  p.doc = from.at(3).toString();
  p.readOnly = from.at(4).toBool();
  p.scalars = static_cast<int>(from.at(6).toInteger());
  p.ofProcess = true;  // it is state and configuration of the other host
  const Property* const own = local ? local->property(p.name) : nullptr;
  if (own)
    p.get = own->get;
  else
    p.get = [name = p.name](const Leaf& leaf) { return linkOf(leaf).read(leaf, name); };
  if (!p.readOnly)
    p.set = [name = p.name](Leaf& leaf, Args& args) { linkOf(leaf).ask(kSet, leaf, {name, rest(args)}); };
  return p;
}

/// True for the method that a class makes of a property itself, which gives its value.
bool isGetter(const std::string& method, const std::vector<Property>& properties) {
  return std::any_of(properties.begin(), properties.end(), [&](const Property& p) {
    std::string name = "get" + p.name;
    if (name[3] >= 'a' && name[3] <= 'z') name[3] = static_cast<char>(name[3] - 'a' + 'A');
    return name == method;
  });
}

Method method(const List& from) {
  Method m;
  m.name = from.at(0).toString();
  m.doc = from.at(1).toString();
  for (const Value& parameter : from.at(2).toList()) m.parameters.push_back(parameter.toString());
  m.returns = from.at(3).toString();
  m.minScalars = static_cast<int>(from.at(4).toInteger());
  m.maxScalars = static_cast<int>(from.at(5).toInteger());
  m.surplusIgnored = from.at(6).toBool();
  if (!m.returns.starts_with('@'))
    m.call = [name = m.name](Leaf& leaf, Args& args) {
      return linkOf(leaf).ask(kCall, leaf, {name, restAsList(args)});
    };
  return m;
}
/// The class of this host, or of one of its bases, whose objects can be scene nodes for those of a class of another
/// host; nullptr: there is none.
ClassObject* localClass(const Kernel& kernel, const List& message) {
  if (message.size() < 9 || message[8].toList().empty()) return nullptr;
  std::vector<std::string> names{message[1].toString()};
  for (const Value& base : message[8].toList()) names.push_back(base.toString());
  // Kinds of transforms, such as robots, do what they do on their own host.
  if (std::find(names.begin(), names.end(), Transform::kClassName) != names.end()) names = {Transform::kClassName};
  for (const std::string& name : names)
    if (ClassObject* const found = kernel.findClass(name); found && isOfScene(*found)) return found;
  return nullptr;
}

/// For scene nodes, which are no RemoteNode.
void describeSceneNode(ClassDescription& d) {
  d.interfaces.push_back({IEventSource::kInterface, [](Leaf* leaf) -> void* {
                            auto* const link = leaf->ancestor<IRemoteLink>();
                            return link ? link->eventsOf(*leaf) : nullptr;
                          }});
  Method values;
  values.name = "values";
  values.doc = "All its properties with their values, in one request.";
  values.returns = "table";
  values.call = [](Leaf& leaf, Args&) { return linkOf(leaf).ask(kRead, leaf, {}); };
  d.methods.push_back(std::move(values));
}
}  // namespace

void ProxyClasses::define(Node& mount, const List& message, std::size_t bytes) {
  try {
    Defined& defined = defined_[message.at(1).toString()];
    if (defined.message == message) return;
    bytes_ += bytes;
    if (++made_ > kMostClasses || bytes_ > kMostBytes)
      throw Error(
          fmt::format("the other host describes more than {} classes, or {} bytes of them", kMostClasses, kMostBytes));
    ClassObject* const local = mount.ancestor<SceneNode>() ? localClass(mount.kernel(), message) : nullptr;
    defined.message = message;
    defined.local = local ? local->name() : std::string();
    defined.plain.clear();
    defined.name = make(mount, defined, local);
    if (!local && mount.ancestor<SceneNode>() && message.size() > 8 && !message[8].toList().empty() &&
        defined.times == 1)
      mount.kernel().log().warning(
          "{}: nodes of the other host's class {} are not in this scene, neither to be seen nor met: no plugin here "
          "has "
          "it. Add plugin \"{}\" to the config.",
          mount.path(), message[1].toString(), message[4].toString());
  } catch (const std::logic_error&) {  // a list is too short
    throw Error("the other host describes a class in a way that is not understood");
  } catch (const std::bad_variant_access&) {
    throw Error("the other host describes a class in a way that is not understood");
  }
}

/// Registers a class that derives from `local`, or from RemoteNode if that is nullptr. Returns its name.
std::string ProxyClasses::make(Node& mount, Defined& defined, ClassObject* local) {
  Kernel& kernel = mount.kernel();
  const List& message = defined.message;
  const std::string& plugin = message.at(4).toString();
  ClassDescription description;
  description.base = local ? local->name() : RemoteNode::kClassName;
  description.doc = plugin.empty() ? message.at(2).toString()
                                   : fmt::format("{} (plugin {} {} of the other host)", message.at(2).toString(),
                                                 plugin, message.at(5).toString());
  if (local)
    description.make = makeAsBase;
  else
    description.make = [] { return std::unique_ptr<Leaf>(std::make_unique<RemoteNode>()); };
  for (const Value& p : message.at(6).toList()) description.properties.push_back(property(p.toList(), local));
  for (const Value& m : message.at(7).toList())
    if (Method made = method(m.toList()); !isGetter(made.name, description.properties))
      description.methods.push_back(std::move(made));
  if (local) describeSceneNode(description);
  const std::string name = fmt::format("{}@{}", message.at(1).toString(), mount.name());
  description.name = name;
  // Not from #2 each time: a host that changes its classes all the time would be searched for longer and longer.
  int n = defined.times + 1;
  while (kernel.findClass(description.name)) description.name = fmt::format("{}#{}", name, ++n);
  defined.times = n;
  return kernel.registerClass(std::move(description), kernel.classOf(RemoteNode::kClassName).plugin()).name();
}

const std::string& ProxyClasses::plain(Node& mount, const std::string& remote) {
  Defined& defined = defined_.at(remote);
  if (defined.plain.empty()) defined.plain = make(mount, defined, nullptr);
  return defined.plain;
}

const ProxyClasses::Defined& ProxyClasses::defined(const std::string& remote) const {
  const auto at = defined_.find(remote);
  if (at == defined_.end()) throw BadMessage(fmt::format("the other host has not described its class {}", remote));
  return at->second;
}

}  // namespace spark::remote
