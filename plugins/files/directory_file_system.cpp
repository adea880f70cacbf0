#include <sys/stat.h>

#include <fstream>

#include "file_server.h"
#include "spark/error.h"
#include "spark/random.h"

namespace fs = std::filesystem;

namespace spark {

namespace {
constexpr std::size_t kMostRemembered = 10000;
}

void DirectoryFileSystem::describe(Description<DirectoryFileSystem>& d) {
  d.doc("A folder as file system; what links lead out of it is refused.");
  d.implements<IFileSystem>();
  d.property("path", &DirectoryFileSystem::path_).doc("The folder.");
  d.property("prefix", &DirectoryFileSystem::prefix, &DirectoryFileSystem::setPrefix)
      .doc("Resource names start with this, and the rest is looked up in the folder: 'rsg/' mounts the folder as rsg.");
  d.property("maxBytes", &DirectoryFileSystem::maxBytes_).unit("bytes").min(0).doc("Larger files are refused.");
}

void DirectoryFileSystem::setPrefix(std::string prefix) {
  while (prefix.starts_with('/')) prefix.erase(0, 1);
  if (!prefix.empty() && !prefix.ends_with('/')) prefix += '/';
  prefix_ = std::move(prefix);
}

std::string DirectoryFileSystem::where() const {
  return "folder '" + (path_.empty() ? std::string("(none)") : path_) + "'" +
         (prefix_.empty() ? "" : " (as '" + prefix_ + "')");
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
    throw Error("resource '" + resource + "' is refused: a link leads out of " + where());
  return file;
}

std::optional<std::string> DirectoryFileSystem::read(const std::string& resource) {
  const auto file = locate(resource);
  if (!file) return {};
  std::error_code failed;
  const fs::file_status status = fs::status(*file, failed);
  if (failed) throw Error("cannot look at '" + file->string() + "': " + failed.message());
  if (fs::is_directory(status)) throw Error("expected a file, found a folder: '" + resource + "' in " + where());
  if (!fs::is_regular_file(status))
    throw Error("expected a plain file, found something else: '" + resource + "' in " + where());
  const std::uintmax_t size = fs::file_size(*file, failed);
  if (failed) throw Error("cannot look at '" + file->string() + "': " + failed.message());
  if (size > static_cast<std::uintmax_t>(maxBytes_))
    throw Error("resource '" + resource + "' is too large: " + std::to_string(size) + " bytes, at most " +
                std::to_string(maxBytes_) + " are allowed (" + path() + ".maxBytes)");
  std::ifstream in(*file, std::ios::binary);
  std::string content(size, '\0');
  if (!in || !in.read(content.data(), static_cast<std::streamsize>(size)))
    throw Error("cannot read '" + file->string() + "'");
  return content;
}

std::uint64_t DirectoryFileSystem::stamp(const std::string& resource) {
  if (path_.empty() || !resource.starts_with(prefix_)) return 0;
  const fs::path file = fs::path(path_) / resource.substr(prefix_.size());
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0 || !S_ISREG(s.st_mode)) return 0;
  const Identity identity{s.st_dev, s.st_ino};
  if (const auto known = inside_.find(resource); known == inside_.end() || known->second != identity) {
    if (!locate(resource)) return 0;
    if (inside_.size() >= kMostRemembered) inside_.clear();  // links in circles give one file many names
    inside_.insert_or_assign(resource, identity);
  }
  const std::int64_t parts[] = {s.st_mtim.tv_sec, s.st_mtim.tv_nsec, s.st_size, static_cast<std::int64_t>(s.st_ino)};
  return std::max<std::uint64_t>(1, hashBytes({reinterpret_cast<const char*>(parts), sizeof parts}) >> 8);
}

}  // namespace spark
