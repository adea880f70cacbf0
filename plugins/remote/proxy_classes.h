#pragma once
/// \file
/// Classes of this host that stand for those of another one.

#include <cstddef>
#include <map>
#include <string>

#include "spark/kernel.h"
#include "spark/value.h"

namespace spark::remote {

/// The classes of the nodes of a mount. Each has the name of the other host's class, '@' and the name of the mount, and
/// the properties and methods that the other host has described.
class ProxyClasses {
 public:
  /// Makes a class, or one that replaces it if the description has changed; nodes that exist keep the old one.
  /// `message`: a message kClass, `bytes`: its length. Throws Error for one that is none, and where there would be more
  /// classes than a host has.
  void define(Node& mount, const List& message, std::size_t bytes);
  /// The class for a class of the other host. Throws BadMessage if that was not described.
  const std::string& of(const std::string& remote) const { return defined(remote).name; }
  /// True if the nodes of that class are scene nodes of this host, whose class derives from one of its own.
  bool isOfScene(const std::string& remote) const { return !defined(remote).local.empty(); }
  /// A class for nodes of that class that cannot be scene nodes.
  const std::string& plain(Node& mount, const std::string& remote);

 private:
  struct Defined {
    List message;
    std::string name;
    std::string local;  ///< the class of this host that it derives from; "": RemoteNode
    std::string plain;  ///< a class beside it that derives from RemoteNode; "": not made yet
    int times = 0;      ///< that classes were made of it
  };
  const Defined& defined(const std::string& remote) const;
  static std::string make(Node& mount, Defined& defined, ClassObject* local);
  std::map<std::string, Defined> defined_;  ///< by the other host's name
  std::size_t made_ = 0, bytes_ = 0;        ///< classes so far, and what their descriptions were to read
};

}  // namespace spark::remote
