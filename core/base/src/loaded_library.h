#pragma once
/// \file
/// Private to the loader: a plugin's file in memory.

#include <sys/stat.h>

#include <memory>
#include <string>

struct link_map;

namespace spark {

/// What tells one content of a file from the next without reading it.
class FileStamp {
 public:
  FileStamp() = default;
  /// `s`: what the system says of the file.
  explicit FileStamp(const struct stat& s);
  /// Of the file now; one that equals no other when it is gone.
  static FileStamp of(const std::string& path);
  bool operator==(const FileStamp& o) const;

 private:
  struct stat s_ = {};
  bool there_ = false;
};

/// A shared library that this process has loaded: a private copy of the file, so that writing to the file does no harm.
/// Kernels that load the same unchanged file share one; it is unmapped when the last of them lets go.
class LoadedLibrary {
 public:
  /// `path`: absolute. Throws Error that names the file and says why it cannot be loaded. Thread safe.
  static std::shared_ptr<LoadedLibrary> load(const std::string& path);
  ~LoadedLibrary();
  LoadedLibrary(const LoadedLibrary&) = delete;
  LoadedLibrary& operator=(const LoadedLibrary&) = delete;

  /// The address of an exported symbol, nullptr when there is none.
  const void* symbol(const char* name) const;
  /// True when there is another file of that name now.
  bool hasChanged() const;

 private:
  explicit LoadedLibrary(const std::string& path) : path_(path) {}
  void open();

  std::string path_;
  FileStamp stamp_;
  void* handle_ = nullptr;          ///< libltdl's
  struct link_map* map_ = nullptr;  ///< the dynamic linker's; of copies only
  char* linkerName_ = nullptr;      ///< what it called the copy
};

}  // namespace spark
