#pragma once
/// \file
/// The file server and the folder as file system.

#include <filesystem>
#include <map>

#include "api/files.h"
#include "spark/describe.h"

namespace spark::files {

/// Checks a resource name and returns its normal form: '/' between components, no empty ones, no ".".
/// Throws Error for empty and absolute names, names that climb out with "..", backslashes, drive letters, control
/// characters.
std::string normalName(std::string_view resource);

}  // namespace spark::files

namespace spark {

/// Finds resources: asks the file systems below it, in order.
class FileServer : public Node, public IFileServer {
  SPARK_CLASS(FileServer, Node)
 public:
  static void describe(Description<FileServer>& d);

  std::string read(std::string_view resource) override;
  bool exists(std::string_view resource) override;
  std::uint64_t stamp(std::string_view resource) override;

 private:
  template <class F>
  void forEach(F visit) const;
  [[noreturn]] void notFound(const std::string& name) const;
  std::string readText(std::string resource) { return read(resource); }
  bool hasResource(std::string resource) { return exists(resource); }
};

/// A folder of the machine. Nothing outside of it is reachable, also not through links.
class DirectoryFileSystem : public Leaf, public IFileSystem {
  SPARK_CLASS(DirectoryFileSystem, Leaf)
 public:
  static void describe(Description<DirectoryFileSystem>& d);

  std::optional<std::string> read(const std::string& resource) override;
  std::uint64_t stamp(const std::string& resource) override;
  std::string where() const override;

 private:
  std::optional<std::filesystem::path> locate(const std::string& resource) const;
  void setPrefix(std::string prefix);
  const std::string& prefix() const { return prefix_; }
  /// Where a resource was found inside: looking whether it is the same file is all that a stamp takes then.
  struct Identity {
    std::uint64_t device, inode;
    bool operator==(const Identity&) const = default;
  };
  std::string path_, prefix_;
  std::int64_t maxBytes_ = 16 << 20;
  std::map<std::string, Identity, std::less<>> inside_;
};

}  // namespace spark
