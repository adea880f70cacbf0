#include "proxy_classes.h"

#include <fmt/format.h>

#include "messages.h"
#include "remote_node.h"
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

const RemoteNode& nodeOf(const Leaf& leaf) { return static_cast<const RemoteNode&>(leaf); }

Property property(const List& from) {
  Property p;
  p.name = from.at(0).toString();
  p.type = from.at(1).toString();
  p.unit = from.at(2).toString();
  p.doc = from.at(3).toString();
  p.readOnly = from.at(4).toBool();
  p.scalars = static_cast<int>(from.at(6).toInteger());
  p.ofProcess = true;  // it is state and configuration of the other host
  p.get = [name = p.name](const Leaf& leaf) { return nodeOf(leaf).link().ask(kGet, leaf, {name}); };
  if (!p.readOnly)
    p.set = [name = p.name](Leaf& leaf, Args& args) { nodeOf(leaf).link().ask(kSet, leaf, {name, rest(args)}); };
  return p;
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
      return nodeOf(leaf).link().ask(kCall, leaf, {name, restAsList(args)});
    };
  return m;
}
}  // namespace

void ProxyClasses::define(Kernel& kernel, const std::string& mount, const List& message, std::size_t bytes) {
  try {
    const std::string remote = message.at(1).toString();
    Defined& defined = defined_[remote];
    if (defined.message == message) return;
    bytes_ += bytes;
    if (++made_ > kMostClasses || bytes_ > kMostBytes)
      throw Error(
          fmt::format("the other host describes more than {} classes, or {} bytes of them", kMostClasses, kMostBytes));
    const std::string& plugin = message.at(4).toString();
    ClassDescription description;
    description.base = RemoteNode::kClassName;
    description.doc = plugin.empty() ? message.at(2).toString()
                                     : fmt::format("{} (plugin {} {} of the other host)", message.at(2).toString(),
                                                   plugin, message.at(5).toString());
    description.make = [] { return std::unique_ptr<Leaf>(std::make_unique<RemoteNode>()); };
    for (const Value& p : message.at(6).toList()) description.properties.push_back(property(p.toList()));
    for (const Value& m : message.at(7).toList()) description.methods.push_back(method(m.toList()));
    const std::string name = fmt::format("{}@{}", remote, mount);
    description.name = name;
    // Not from #2 each time: a host that changes its classes all the time would be searched for longer and longer.
    int n = defined.times + 1;
    while (kernel.findClass(description.name)) description.name = fmt::format("{}#{}", name, ++n);
    defined = {message, description.name, n};
    kernel.registerClass(std::move(description), kernel.classOf(RemoteNode::kClassName).plugin());
  } catch (const std::logic_error&) {  // a list is too short
    throw Error("the other host describes a class in a way that is not understood");
  } catch (const std::bad_variant_access&) {
    throw Error("the other host describes a class in a way that is not understood");
  }
}

const std::string& ProxyClasses::of(const std::string& remote) const {
  const auto at = defined_.find(remote);
  if (at == defined_.end()) throw BadMessage(fmt::format("the other host has not described its class {}", remote));
  return at->second.name;
}

}  // namespace spark::remote
