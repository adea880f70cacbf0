#pragma once
/// \file
/// Files: a server that asks the file systems below it, in order.

#include <optional>
#include <string>

#include "spark/abi/api/files.h"
#include "spark/node.h"

namespace spark {

/// Below the file server: a folder, an archive.
class IFileSystem {
 public:
  SPARK_INTERFACE(IFileSystem, 1);
  virtual ~IFileSystem() = default;
  /// The content of a resource ("rsg/agent/sphere.rsg"), nothing when it has none of that name. Throws Error when it
  /// cannot be read.
  virtual std::optional<std::string> read(const std::string& resource) = 0;
  /// Changes when the resource's content may have changed (modification time, archive identity); 0 when it does not
  /// exist.
  virtual std::uint64_t stamp(const std::string& resource) = 0;
  /// For messages: where it looks.
  virtual std::string where() const = 0;
};

/// The file server, at /sys/server/file. Resource names are relative, with '/', never climbing out: others throw Error.
class IFileServer {
 public:
  SPARK_INTERFACE(IFileServer, 1);
  static constexpr const char* kPath = "/sys/server/file";
  virtual ~IFileServer() = default;
  /// The content from the first file system that has it. Throws Error: bad name, is a folder, not found (says where it
  /// looked), too large.
  virtual std::string read(std::string_view resource) = 0;
  virtual bool exists(std::string_view resource) = 0;
  /// Changes when read() may give something else; for caches.
  virtual std::uint64_t stamp(std::string_view resource) = 0;
};

}  // namespace spark
