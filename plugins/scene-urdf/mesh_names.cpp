#include <algorithm>
#include <filesystem>

#include "urdf_reader.h"

namespace spark::urdf {

std::vector<std::string> meshNames(std::string_view of, std::string_view name) {
  namespace fs = std::filesystem;
  std::string package;
  for (const std::string_view scheme : {"package://", "model://", "file://"})
    if (name.starts_with(scheme)) {
      name.remove_prefix(scheme.size());
      if (scheme == "file://") break;
      const std::size_t slash = std::min(name.find('/'), name.size());
      package = name.substr(0, slash);
      name.remove_prefix(std::min(slash + 1, name.size()));
      break;
    }
  while (name.starts_with('/')) name.remove_prefix(1);
  std::vector<std::string> out;
  const auto add = [&out](const fs::path& path) {
    std::string text = path.lexically_normal().generic_string();
    if (text.starts_with("..") || text.starts_with("/") || std::find(out.begin(), out.end(), text) != out.end()) return;
    out.push_back(std::move(text));
  };
  const fs::path folder = fs::path(of).parent_path();
  if (package.empty()) add(folder / name);
  // The package's folder is one of those around the file, or beside one of them, or all are in the folder of files.
  for (fs::path up = folder;; up = up.parent_path()) {
    if (!package.empty() && up.filename() == package) add(up / name);
    if (!package.empty()) add(up / package / name);
    add(up / name);
    if (up.empty() || up == up.parent_path()) break;
  }
  return out;
}

}  // namespace spark::urdf
