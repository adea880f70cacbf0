#include "zip_file_system.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include "spark/error.h"
#include "spark/plugin.h"
#include "spark/random.h"

namespace spark {

void ZipFileSystem::describe(Description<ZipFileSystem>& d) {
  d.doc("A zip archive as file system.");
  d.implements<IFileSystem>();
  d.property("path", &ZipFileSystem::file, &ZipFileSystem::setFile).ofProcess().doc("The archive.");
  d.property("prefix", &ZipFileSystem::prefix, &ZipFileSystem::setPrefix)
      .doc("Prefix of resource names; the rest is looked up in the archive. 'rsg/' mounts the archive as rsg.");
  d.property("maxBytes", &ZipFileSystem::maxBytes_)
      .unit("bytes")
      .min(0)
      .doc("Members that are larger unpacked are refused.");
}

void ZipFileSystem::setFile(std::string path) {
  path_ = std::move(path);
  archive_.reset();
}

void ZipFileSystem::setPrefix(std::string prefix) {
  while (prefix.starts_with('/')) prefix.erase(0, 1);
  if (!prefix.empty() && !prefix.ends_with('/')) prefix += '/';
  prefix_ = std::move(prefix);
}

std::string ZipFileSystem::where() const {
  return fmt::format("archive '{}'{}", path_.empty() ? "(none)" : path_,
                     prefix_.empty() ? "" : fmt::format(" (as '{}')", prefix_));
}

bool ZipFileSystem::refresh() {
  // Check whether the file has changed.
  struct stat s {};
  if (path_.empty() || ::stat(path_.c_str(), &s) != 0) {
    archive_.reset();
    return false;
  }
  const std::int64_t parts[] = {s.st_mtim.tv_sec,  s.st_mtim.tv_nsec, s.st_ctim.tv_sec,
                                s.st_ctim.tv_nsec, s.st_size,         static_cast<std::int64_t>(s.st_ino)};
  const std::uint64_t identity =
      std::max<std::uint64_t>(1, hashBytes({reinterpret_cast<const char*>(parts), sizeof parts}) >> 8);
  if (archive_ && identity == identity_) return true;

  int code = 0;
  archive_.reset(zip_open(path_.c_str(), ZIP_RDONLY, &code));
  if (!archive_) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw Error(fmt::format("cannot open {}: {}", where(), why));
  }
  identity_ = identity;
  return true;
}

zip_int64_t ZipFileSystem::locate(const std::string& resource) {
  if (!resource.starts_with(prefix_) || !refresh()) return -1;
  return zip_name_locate(archive_.get(), resource.c_str() + prefix_.size(), ZIP_FL_ENC_GUESS);
}

std::optional<std::string> ZipFileSystem::read(const std::string& resource) {
  const zip_int64_t index = locate(resource);
  if (index < 0) {
    if (archive_ && locate(resource + "/") >= 0)
      throw Error(fmt::format("expected a file, found a folder: '{}' in {}", resource, where()));
    return {};
  }
  const auto fail = [&](const std::string& why) {
    throw Error(fmt::format("cannot read '{}' in {}: {}", resource, where(), why));
  };

  // Refuse members that are encrypted or too large.
  zip_stat_t stat;
  if (zip_stat_index(archive_.get(), static_cast<zip_uint64_t>(index), 0, &stat) != 0)
    fail(zip_strerror(archive_.get()));
  if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) && stat.encryption_method != ZIP_EM_NONE) fail("it is encrypted");
  if (!(stat.valid & ZIP_STAT_SIZE)) fail("its size is unknown");
  if (stat.size > static_cast<zip_uint64_t>(maxBytes_))
    fail(fmt::format("it is too large: {} bytes, at most {} are allowed ({}.maxBytes)", stat.size, maxBytes_, path()));

  // Unpack.
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
      zip_fopen_index(archive_.get(), static_cast<zip_uint64_t>(index), 0), zip_fclose);
  if (!file) fail(zip_strerror(archive_.get()));
  std::string content(stat.size, '\0');
  for (std::size_t have = 0; have < content.size();) {
    const zip_int64_t n = zip_fread(file.get(), content.data() + have, content.size() - have);
    if (n < 0) fail(zip_file_strerror(file.get()));
    if (n == 0) fail(fmt::format("it ends after {} of {} bytes", have, content.size()));
    have += n;
  }
  // libzip compares the checksum when the end of the data is read: read one byte more.
  char beyond = 0;
  if (zip_fread(file.get(), &beyond, 1) != 0) fail("its data does not fit its checksum or size");
  return content;
}

std::uint64_t ZipFileSystem::stamp(const std::string& resource) {
  const zip_int64_t index = locate(resource);
  return index < 0 ? 0 : identity_;
}

}  // namespace spark

SPARK_PLUGIN("files-zip", "1.0", "Zip archives as file systems.", spark::ZipFileSystem)
