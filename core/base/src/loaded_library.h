#pragma once
/// \file
/// Private to the loader: the shared library of a plugin, loaded into this process.

#include <sys/stat.h>

#include <memory>
#include <string>

struct link_map;

namespace spark {

/// Identifies a version of a file without reading it: device, inode, size, times of change.
class FileStamp {
 public:
  /// The stamp of no file. It equals no stamp, not even itself.
  FileStamp() = default;
  /// The stamp of the file that `s` describes.
  explicit FileStamp(const struct stat& s);
  /// The stamp of the file at `path` now; the stamp of no file if there is none.
  static FileStamp of(const std::string& path);
  bool operator==(const FileStamp& o) const;

 private:
  struct stat s_ = {};
  bool there_ = false;
};

/// A shared library that this process has loaded, as a private copy of its file: writing to the file does not affect
/// it. Kernels that load the same unchanged file share one. It is unmapped when its last owner releases it.
class LoadedLibrary {
 public:
  /// Loads the library at the absolute `path`. Throws Error with the name of the file and the reason. Thread safe.
  static std::shared_ptr<LoadedLibrary> load(const std::string& path);
  ~LoadedLibrary();
  LoadedLibrary(const LoadedLibrary&) = delete;
  LoadedLibrary& operator=(const LoadedLibrary&) = delete;

  /// The address of an exported symbol, nullptr if there is none. Valid while the library is loaded. Thread safe.
  const void* symbol(const char* name) const;
  /// True if the path now has a file of another version.
  bool hasChanged() const;
  /// True if that is so for a library that was loaded from the path. Thread safe.
  static bool hasChanged(const std::string& path);

 private:
  explicit LoadedLibrary(const std::string& path) : path_(path) {}
  void open();

  std::string path_;
  FileStamp stamp_;                 ///< of the file when it was copied
  void* handle_ = nullptr;          ///< of libltdl
  struct link_map* map_ = nullptr;  ///< the linker's entry; nullptr unless a copy is loaded
  char* linkerName_ = nullptr;      ///< the name in that entry before it was replaced
};

}  // namespace spark
