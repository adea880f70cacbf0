#pragma once
/// \file
/// A zip archive as file system.

#include <zip.h>

#include <memory>

#include "api/files.h"
#include "spark/describe.h"

namespace spark {

/// A zip archive. It is opened when it is first used, and again whenever the file changed. Encrypted members are
/// refused.
class ZipFileSystem : public Leaf, public IFileSystem {
  SPARK_CLASS(ZipFileSystem, Leaf)
 public:
  static void describe(Description<ZipFileSystem>& d);

  std::optional<std::string> read(const std::string& resource) override;
  std::uint64_t stamp(const std::string& resource) override;
  std::string where() const override;

 private:
  /// Closes an archive.
  struct Close {
    void operator()(zip_t* archive) const { zip_discard(archive); }
  };
  /// Opens the archive where needed. Returns false when the file does not exist; throws Error when it is no archive.
  bool refresh();
  /// Index of the member of that name, -1 when there is none.
  zip_int64_t locate(const std::string& resource);
  const std::string& file() const { return path_; }
  void setFile(std::string path);
  const std::string& prefix() const { return prefix_; }
  void setPrefix(std::string prefix);

  std::string path_, prefix_;
  std::int64_t maxBytes_ = 16 << 20;
  std::unique_ptr<zip_t, Close> archive_;
  std::uint64_t identity_ = 0;  ///< hash of age, size and inode of the file when it was opened
};

}  // namespace spark
