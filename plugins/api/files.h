#pragma once
/// \file
/// Files: the file server searches the file systems below it, in order.

#include <filesystem>
#include <optional>
#include <string>

#include "spark/abi/api/files.h"
#include "spark/node.h"

namespace spark {

/// A source of files, such as a folder or an archive. A child of the file server.
class IFileSystem {
 public:
  SPARK_INTERFACE(IFileSystem, 2);
  virtual ~IFileSystem() = default;
  /// The content of a resource ("rsg/agent/sphere.rsg"); nullopt when it does not exist. Throws Error when it exists
  /// but cannot be read.
  virtual std::optional<std::string> read(const std::string& resource) = 0;
  /// A number that differs when the resource's content may have changed (modification time, identity of the archive);
  /// 0 when it does not exist.
  virtual std::uint64_t stamp(const std::string& resource) = 0;
  /// The file of the host that holds the resource and nothing else; nullopt when it does not exist, or is a member of
  /// an archive. Throws Error when it may not be read.
  virtual std::optional<std::filesystem::path> hostFile(const std::string& /*resource*/) { return {}; }
  /// What it searches, for messages: "folder '/usr/share/spark'".
  virtual std::string where() const = 0;
};

/// The file server, at /sys/server/file. A resource name is a relative path with '/' as separator and without "..". All
/// functions throw Error for other names.
class IFileServer {
 public:
  SPARK_INTERFACE(IFileServer, 2);
  static constexpr const char* kPath = "/sys/server/file";
  virtual ~IFileServer() = default;
  /// The content from the first file system that has the resource. Throws Error for a bad name, a folder, a file that
  /// is too large, and when no file system has it; then the text names the file systems that were searched.
  virtual std::string read(std::string_view resource) = 0;
  /// True when a file system has the resource.
  virtual bool exists(std::string_view resource) = 0;
  /// A number that differs when read() may return another content, for caches; 0 when the resource does not exist.
  virtual std::uint64_t stamp(std::string_view resource) = 0;
  /// The file of the host that read() would read, so that other threads can read it; nullopt when the resource does not
  /// exist, or is a member of an archive. Throws Error for a bad name, and when it may not be read.
  virtual std::optional<std::filesystem::path> hostFile(std::string_view /*resource*/) { return {}; }
};

}  // namespace spark
