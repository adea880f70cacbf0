#pragma once
/// \file
/// Private to the loader: a file descriptor with an owner.

#include <unistd.h>

#include <cstddef>
#include <cstdint>

namespace spark {

/// Owns a file descriptor and closes it. A negative one means that the file could not be opened.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  /// The descriptor, for system calls.
  operator int() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Reads `count` objects at `offset` [bytes] of a file. Returns false unless all of them could be read.
template <class T>
bool readAt(int file, std::uint64_t offset, T* to, std::size_t count) {
  const auto bytes = static_cast<ssize_t>(count * sizeof(T));
  return pread(file, to, count * sizeof(T), static_cast<off_t>(offset)) == bytes;
}

}  // namespace spark
