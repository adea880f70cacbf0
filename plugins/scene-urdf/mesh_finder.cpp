#include "mesh_finder.h"

#include <fmt/format.h>

#include <algorithm>

#include "meshes/mesh_file.h"

namespace fs = std::filesystem;

namespace spark::urdf {

namespace {

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// How many of the last parts of two names are the same.
std::size_t commonEnd(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::size_t n = 0;
  while (n < a.size() && n < b.size() && lower(a[a.size() - 1 - n]) == lower(b[b.size() - 1 - n])) ++n;
  return n;
}

}  // namespace

FoundMesh MeshFinder::read(const std::string& resource, const std::string& insteadOf) {
  std::vector<std::string> leftOut;
  FoundMesh out(meshes::readMesh(resource, files_.read(resource), &leftOut), insteadOf);
  out.leftOut = std::move(leftOut);
  return out;
}

FoundMesh MeshFinder::read(const std::string& name) {
  for (const std::string& candidate : meshNames(of_, name))
    if (files_.exists(candidate)) return read(candidate, "");
  const std::string other = similar(name);
  if (other.empty())
    throw Error(
        fmt::format("there is no such file in the folders around '{}': give the folder of its package with "
                    "--scene-path",
                    of_));
  return read(other, other);
}

std::string MeshFinder::similar(const std::string& name) {
  const std::vector<std::string> wanted = partsOf(name);
  if (wanted.empty()) return "";
  if (!isListed_) list();
  std::string best;
  std::size_t most = 0;
  const auto found = byBaseName_.find(lower(wanted.back()));
  if (found == byBaseName_.end()) return "";
  for (const Listed& candidate : found->second) {
    const std::size_t common = commonEnd(wanted, partsOf(candidate.name));
    if (common <= most || (common < 2 && !candidate.near) || !files_.exists(candidate.name)) continue;
    most = common;
    best = candidate.name;
  }
  return best;
}

/// The names of all files around the robot's own, from its folder upwards to that of the file system.
void MeshFinder::list() {
  isListed_ = true;
  const auto own = files_.hostFile(of_);
  if (!own) return;
  fs::path folder = own->parent_path(), resource = fs::path(of_).parent_path(), without;
  for (level_ = 0;; ++level_) {
    list(folder, without, resource.generic_string());
    if (resource.empty() || resource.filename() != folder.filename()) return;
    without = folder;
    folder = folder.parent_path();
    resource = resource.parent_path();
  }
}

/// In an order that does not depend on the machine. Links are not followed.
void MeshFinder::list(const fs::path& folder, const fs::path& without, const std::string& prefix) {
  std::error_code failed;
  std::vector<fs::directory_entry> entries;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
    entries.push_back(*it);
  std::sort(entries.begin(), entries.end());
  const std::string before = prefix.empty() ? "" : prefix + "/";
  for (const fs::directory_entry& entry : entries) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(".") || entry.path() == without || ++listed_ > kMaxListed) continue;
    if (entry.is_regular_file(failed)) byBaseName_[lower(name)].push_back({before + name, level_ < 2});
    if (entry.is_directory(failed) && !entry.is_symlink(failed)) list(entry.path(), without, before + name);
  }
}

}  // namespace spark::urdf
