#include <algorithm>
#include <filesystem>

#include "urdf_reader.h"

namespace spark::urdf {

namespace {

/// A name without its scheme; `package` is that of `package://NAME/...`, if there is one.
struct Plain {
  std::string package, rest;
};

Plain plainOf(std::string_view name) {
  Plain out;
  std::string rest(name);
  std::replace(rest.begin(), rest.end(), '\\', '/');
  bool inPackage = false;
  for (const std::string_view scheme : {"package:", "model:", "file:", "http:", "https:"})
    if (rest.starts_with(scheme)) {
      rest.erase(0, scheme.size());
      inPackage = scheme == "package:" || scheme == "model:";
      break;
    }
  rest.erase(0, std::min(rest.find_first_not_of('/'), rest.size()));
  // What xacro would have replaced.
  constexpr std::string_view kFind = "$(find ";
  if (const std::size_t end = rest.find(')'); rest.starts_with(kFind) && end != std::string::npos) {
    rest = rest.substr(kFind.size(), end - kFind.size()) + rest.substr(end + 1);
    inPackage = true;
  }
  if (inPackage) {
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    out.package = rest.substr(0, slash);
    rest.erase(0, std::min(slash + 1, rest.size()));
  }
  rest.erase(0, std::min(rest.find_first_not_of('/'), rest.size()));
  out.rest = std::move(rest);
  return out;
}

}  // namespace

std::vector<std::string> meshNames(std::string_view of, std::string_view name) {
  namespace fs = std::filesystem;
  const auto [package, file] = plainOf(name);
  std::vector<std::string> out;
  const auto add = [&out](const fs::path& path) {
    std::string text = path.lexically_normal().generic_string();
    const bool outside = text.empty() || text.starts_with("..") || text.starts_with("/") || text.ends_with("/");
    if (outside || text.find(':') != std::string::npos || text.size() > 1000) return;
    if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
  };
  const fs::path folder = fs::path(of).parent_path();
  if (package.empty()) add(folder / file);
  // The package's folder is one of those around the file, or beside one of them, or all are in the folder of files.
  for (fs::path up = folder;; up = up.parent_path()) {
    if (!package.empty() && up.filename() == package) add(up / file);
    if (!package.empty()) add(up / package / file);
    add(up / file);
    if (up.empty() || up == up.parent_path()) break;
  }
  return out;
}

std::vector<std::string> partsOf(std::string_view name) {
  const auto [package, file] = plainOf(name);
  std::vector<std::string> out;
  if (!package.empty()) out.push_back(package);
  for (std::size_t at = 0; at < file.size();) {
    const std::size_t slash = std::min(file.find('/', at), file.size());
    if (slash > at) out.push_back(file.substr(at, slash - at));
    at = slash + 1;
  }
  return out;
}

}  // namespace spark::urdf
