#include "recorded_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "spark/error.h"

namespace sparkhost {

namespace fs = std::filesystem;

namespace {
constexpr std::string_view kScript = "script:", kFile = "file:";

/// The place of an attachment in the folder; empty if it has none there.
fs::path placeOf(std::string_view name) {
  fs::path out;
  if (name.starts_with(kScript)) {
    const fs::path script(name.substr(kScript.size()));
    out = fs::path("lua") / (script.is_absolute() ? script.filename() : script);
  } else if (name.starts_with(kFile)) {
    out = fs::path("files") / fs::path(name.substr(kFile.size())).relative_path();
  }
  const fs::path plain = out.lexically_normal();
  const bool inside = std::none_of(plain.begin(), plain.end(), [](const fs::path& part) { return part == ".."; });
  return inside ? plain : fs::path();
}

/// Copies all files of a folder that `to` has not.
void copyFiles(const fs::path& from, const fs::path& to) {
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(from, ignored)) {
    const fs::path place = to / entry.path().lexically_relative(from);
    if (entry.is_directory())
      fs::create_directories(place, ignored);
    else if (!fs::exists(place))
      fs::copy_file(entry.path(), place, ignored);
  }
}

std::string newFolder() {
  std::string name = (fs::temp_directory_path() / "spark-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw spark::Error(fmt::format("cannot make a folder {}: {}", name, std::strerror(errno)));
  return name;
}

void writeFile(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  if (!out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
    throw spark::Error(fmt::format("cannot write {}", file.string()));
}
}  // namespace

RecordedFiles::Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

RecordedFiles::RecordedFiles(const spark::mcap::Reader& recording, const fs::path& installed) : folder_{newFolder()} {
  for (const char* part : {"lua", "files"}) fs::create_directory(share() / part);
  for (const auto& a : recording.attachments()) try {
      const fs::path place = placeOf(a.name);
      if (place.empty() || fs::exists(share() / place)) continue;  // the first one is what the run began with
      writeFile(share() / place, recording.read(a));
    } catch (const std::exception& e) {
      lacks_.emplace_back(e.what());
    }
  if (!fs::is_directory(installed)) return;
  for (const auto& entry : fs::directory_iterator(fs::canonical(installed)))
    if (const fs::path place = share() / entry.path().filename(); fs::exists(place))
      copyFiles(fs::canonical(entry.path()), place);
    else
      fs::create_symlink(fs::canonical(entry.path()), place);
}

}  // namespace sparkhost
