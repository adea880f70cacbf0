#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "file_server.h"
#include "spark/error.h"
#include "spark/output_file.h"
#include "spark/random.h"

namespace fs = std::filesystem;

namespace spark {

namespace {
constexpr std::size_t kMaxCached = 10000;  // identities
}

void DirectoryFileSystem::describe(Description<DirectoryFileSystem>& d) {
  d.doc("A folder as file system. Files outside of it cannot be reached, not even through links.");
  d.implements<IFileSystem>();
  d.property("path", &DirectoryFileSystem::path_).ofProcess().doc("The folder.");
  d.property("prefix", &DirectoryFileSystem::prefix, &DirectoryFileSystem::setPrefix)
      .doc("Prefix of resource names; the rest is looked up in the folder. 'rsg/' mounts the folder as rsg.");
  d.property("maxBytes", &DirectoryFileSystem::maxBytes_).unit("bytes").min(0).doc("Larger files are refused.");
}

void DirectoryFileSystem::setPrefix(std::string prefix) {
  while (prefix.starts_with('/')) prefix.erase(0, 1);
  if (!prefix.empty() && !prefix.ends_with('/')) prefix += '/';
  prefix_ = std::move(prefix);
}

std::string DirectoryFileSystem::where() const {
  return fmt::format("folder '{}'{}", path_.empty() ? "(none)" : path_,
                     prefix_.empty() ? "" : fmt::format(" (as '{}')", prefix_));
}

std::optional<fs::path> DirectoryFileSystem::locate(const std::string& resource) const {
  if (path_.empty() || !resource.starts_with(prefix_)) return {};
  std::error_code failed;
  const fs::path root = fs::canonical(path_, failed);
  if (failed) return {};
  const fs::path file = fs::canonical(root / resource.substr(prefix_.size()), failed);
  if (failed) return {};
  const fs::path inside = file.lexically_relative(root);
  if (inside.empty() || *inside.begin() == "..")
    throw Error(fmt::format("resource '{}' is refused: a link leads out of {}", resource, where()));
  return file;
}

std::optional<std::string> DirectoryFileSystem::read(const std::string& resource) {
  const auto file = locate(resource);
  if (!file) return {};

  // Only plain files of limited size.
  std::error_code failed;
  const fs::file_status status = fs::status(*file, failed);
  if (failed) throw Error(fmt::format("cannot look at '{}': {}", file->string(), failed.message()));
  if (fs::is_directory(status))
    throw Error(fmt::format("expected a file, found a folder: '{}' in {}", resource, where()));
  if (!fs::is_regular_file(status))
    throw Error(fmt::format("expected a plain file, found something else: '{}' in {}", resource, where()));
  const std::uintmax_t size = fs::file_size(*file, failed);
  if (failed) throw Error(fmt::format("cannot look at '{}': {}", file->string(), failed.message()));
  if (size > static_cast<std::uintmax_t>(maxBytes_))
    throw Error(fmt::format("resource '{}' is too large: {} bytes, at most {} are allowed ({}.maxBytes)", resource,
                            size, maxBytes_, path()));

  outputs::keep(file->string());
  std::ifstream in(*file, std::ios::binary);
  std::string content(size, '\0');
  if (!in) throw Error(fmt::format("cannot open '{}': {}", file->string(), std::strerror(errno)));
  if (!in.read(content.data(), static_cast<std::streamsize>(size)))
    throw Error(fmt::format("cannot read '{}'", file->string()));
  return content;
}

std::uint64_t DirectoryFileSystem::stamp(const std::string& resource) {
  if (path_.empty() || !resource.starts_with(prefix_)) return 0;
  const std::string file = path_ + '/' + resource.substr(prefix_.size());
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0 || !S_ISREG(s.st_mode)) return 0;

  // A new file: check that it is inside of the folder.
  const Identity identity{s.st_dev, s.st_ino};
  if (const auto known = inside_.find(resource); known == inside_.end() || known->second != identity) {
    if (!locate(resource)) return 0;
    if (inside_.size() >= kMaxCached) inside_.clear();  // circular links give a file any number of names
    inside_.insert_or_assign(resource, identity);
  }

  // Times of the last changes of contents and of anything (a copy may keep the first), size and inode.
  const std::int64_t parts[] = {s.st_mtim.tv_sec,  s.st_mtim.tv_nsec, s.st_ctim.tv_sec,
                                s.st_ctim.tv_nsec, s.st_size,         static_cast<std::int64_t>(s.st_ino)};
  return std::max<std::uint64_t>(1, hashBytes({reinterpret_cast<const char*>(parts), sizeof parts}) >> 8);
}

}  // namespace spark
