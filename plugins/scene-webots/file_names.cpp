#include <algorithm>
#include <filesystem>

#include "document.h"

namespace spark::webots {

std::vector<std::string> fileNames(std::string_view of, std::string_view url, const std::vector<std::string>& folders) {
  namespace fs = std::filesystem;
  std::vector<std::string> out;
  const auto add = [&out](const fs::path& path) {
    std::string text = path.lexically_normal().generic_string();
    const bool outside = text.empty() || text.starts_with("..") || text.starts_with("/");
    if (!outside && std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
  };
  const fs::path folder = fs::path(of).parent_path();
  bool relative = true;
  for (const std::string_view scheme : {"webots://", "https://", "http://", "file://"})
    if (url.starts_with(scheme)) {
      relative = false;
      url.remove_prefix(scheme.size());
      // Addresses of Webots' own files: HOST/OWNER/REPOSITORY/VERSION/projects/...
      if (const std::size_t projects = url.find("/projects/"); projects != std::string_view::npos)
        url.remove_prefix(projects + 1);
      break;
    }
  if (relative) add(folder / url);
  // In a copy of those folders, or all files side by side.
  const fs::path name = fs::path(url).filename();
  for (fs::path up = folder;; up = up.parent_path()) {
    if (!relative) add(up / url);
    add(up / name);
    add(up / "protos" / name);
    if (up.empty() || up == up.parent_path()) break;
  }
  for (const fs::path other : folders) {
    if (!relative) add(other / url);
    add(other / name);
    add(other / "protos" / name);
  }
  return out;
}

}  // namespace spark::webots
