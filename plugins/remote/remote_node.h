#pragma once
/// \file
/// Nodes that stand for nodes of another host, and what their mount does for them.

#include <string>

#include "spark/describe.h"
#include "spark/event.h"
#include "spark/node.h"

namespace spark {

/// The link to another host, as its nodes use it.
class IRemoteLink {
 public:
  SPARK_INTERFACE(IRemoteLink, 1);
  virtual ~IRemoteLink() = default;
  /// Asks the other host about one of its nodes, and waits for the answer. `request`: a kind of messages.h. Throws
  /// Error with the reason of the other host, or if the link is lost.
  virtual Value ask(std::string_view request, const Leaf& node, List arguments) = 0;
  /// The value of a property: the last that came, or what the other host answers. Throws as ask().
  virtual Value read(const Leaf& node, const std::string& property) = 0;
  /// The other host passes the events of a channel to a node from now on. Throws as ask().
  virtual void listen(Leaf& node, const std::string& channel) = 0;
  /// Passes events to a scene node. Owned by the link.
  virtual IEventSource* eventsOf(Leaf& node) = 0;
  /// Handles what has arrived. Between two cycles.
  virtual void poll() = 0;
  /// True if something has arrived that poll() has not handled yet: waiting for the descriptor would miss it.
  virtual bool isPending() const = 0;
  /// As of the system, for waiting; -1 while there is no connection.
  virtual int descriptor() = 0;
};

/// The link above a node of another host. Throws Error if it was taken out of its mount.
inline IRemoteLink& linkOf(const Leaf& node) {
  if (auto* const found = node.ancestor<IRemoteLink>()) return *found;
  throw Error("this node of another host was taken out of its mount");
}

/// A node of another host, below a RemoteMount, that is no scene node of this one. Its class has the properties and
/// methods that the class of the other host has: reading, writing and calling them is a request to that host.
class RemoteNode : public Node, public IEventSource {
  SPARK_CLASS(RemoteNode, Node)
 public:
  static void describe(Description<RemoteNode>& d) {
    d.doc("A node of another host, below a RemoteMount.");
    d.implements<IEventSource>();
    d.method("values", &RemoteNode::values).doc("All its properties with their values, in one request.");
  }
  void listened(const std::string& channel) override { linkOf(*this).listen(*this, channel); }

 private:
  TableValue values() const;
};

}  // namespace spark
