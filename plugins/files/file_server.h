#pragma once
/// \file
/// The file server, and folders as file systems.

#include <filesystem>
#include <map>

#include "api/files.h"
#include "spark/describe.h"

namespace spark::files {

/// Checks a resource name and returns its normal form: components separated by one '/', without ".". Throws Error for
/// empty and absolute names, and for names with "..", backslashes, colons or control characters, or of more than 1024
/// bytes.
std::string normalName(std::string_view resource);

}  // namespace spark::files

namespace spark {

/// Finds resources by name in the file systems below it. The first that has a resource delivers it.
class FileServer : public Node, public IFileServer {
  SPARK_CLASS(FileServer, Node)
 public:
  static void describe(Description<FileServer>& d);
  /// A node whose file systems come before those of all file servers: the files of a recording that is simulated again.
  static constexpr const char* kOfProgram = "/sys/host/files";

  std::string read(std::string_view resource) override;
  bool exists(std::string_view resource) override;
  std::uint64_t stamp(std::string_view resource) override;
  std::optional<std::filesystem::path> hostFile(std::string_view resource) override;

 private:
  /// Calls `visit` for the file systems, in order, until it returns true: first for those of the program (kOfProgram).
  template <class F>
  void forEach(F visit) const;
  /// Throws Error with the file systems that were searched.
  [[noreturn]] void notFound(const std::string& name) const;
  std::string readText(const std::string& resource) { return read(resource); }
  bool hasResource(const std::string& resource) { return exists(resource); }
};

/// A folder of the host. Files outside of it cannot be reached, not even through symbolic links.
class DirectoryFileSystem : public Leaf, public IFileSystem {
  SPARK_CLASS(DirectoryFileSystem, Leaf)
 public:
  static void describe(Description<DirectoryFileSystem>& d);

  std::optional<std::string> read(const std::string& resource) override;
  std::uint64_t stamp(const std::string& resource) override;
  std::optional<std::filesystem::path> hostFile(const std::string& resource) override { return locate(resource); }
  std::string where() const override;

 private:
  /// The path of a resource with all links resolved; nullopt when it does not exist. Throws Error when it is outside of
  /// the folder.
  std::optional<std::filesystem::path> locate(const std::string& resource) const;
  void setPrefix(std::string prefix);
  const std::string& prefix() const { return prefix_; }
  /// Identity of a file.
  struct Identity {
    std::uint64_t device, inode;
    bool operator==(const Identity&) const = default;
  };
  std::string path_, prefix_;
  std::int64_t maxBytes_ = 16 << 20;
  /// Files known to be inside of the folder, by resource: while the identity is the same, stamp() need not resolve
  /// links.
  std::map<std::string, Identity, std::less<>> inside_;
};

}  // namespace spark
