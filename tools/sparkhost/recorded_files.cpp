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
constexpr std::string_view kScript = "script:", kFile = "file:", kScenes = "rsg/";

/// The place of an attachment in the share; empty if it has none there.
fs::path placeOf(std::string_view name) {
  fs::path out;
  if (name.starts_with(kScript)) {
    const fs::path script(name.substr(kScript.size()));
    out = fs::path("lua") / (script.is_absolute() ? script.filename() : script);
  } else if (name.starts_with(kFile)) {
    name.remove_prefix(kFile.size());
    if (name.starts_with(kScenes)) name.remove_prefix(kScenes.size());  // as the share is mounted
    out = fs::path("scenes") / fs::path(name).relative_path();
  }
  const fs::path plain = out.lexically_normal();
  const bool inside = std::none_of(plain.begin(), plain.end(), [](const fs::path& part) { return part == ".."; });
  return inside ? plain : fs::path();
}
}  // namespace

namespace {
/// Copies all files of a folder that `to` has not. Links would lead out of it, which the file server refuses.
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
}  // namespace

RecordedFiles::RecordedFiles(const spark::mcap::Reader& recording, const fs::path& installed) {
  std::string name = (fs::temp_directory_path() / "spark-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw spark::Error(fmt::format("cannot make a folder {}: {}", name, std::strerror(errno)));
  folder_ = name;
  fs::create_directory(folder_ / "lua");
  fs::create_directory(folder_ / "scenes");
  for (const auto& a : recording.attachments()) {
    const fs::path place = placeOf(a.name);
    if (place.empty() || fs::exists(folder_ / place)) continue;  // the first one is what the run began with
    try {
      const std::string bytes = recording.read(a);
      fs::create_directories((folder_ / place).parent_path());
      std::ofstream out(folder_ / place, std::ios::binary);
      if (!out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
        throw spark::Error(fmt::format("cannot write {}", (folder_ / place).string()));
    } catch (const std::exception& e) {
      lacks_.emplace_back(e.what());
    }
  }
  if (!fs::is_directory(installed)) return;
  for (const auto& entry : fs::directory_iterator(fs::canonical(installed)))
    if (fs::exists(folder_ / entry.path().filename()))
      copyFiles(fs::canonical(entry.path()), folder_ / entry.path().filename());
    else
      fs::create_symlink(fs::canonical(entry.path()), folder_ / entry.path().filename());
}

RecordedFiles::~RecordedFiles() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace sparkhost
