#include "file_index.h"

#include <algorithm>
#include <filesystem>

namespace spark::webots {

namespace fs = std::filesystem;

namespace {

bool isWanted(std::string ending) {
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".proto" || ending == ".stl" || ending == ".obj" || ending == ".dae";
}

/// Number of folders at the begin of both names.
int common(const fs::path& a, const fs::path& b) {
  int out = 0;
  for (auto i = a.begin(), k = b.begin(); i != a.end() && k != b.end() && *i == *k; ++i, ++k) ++out;
  return out;
}

}  // namespace

const std::vector<std::string>& FileIndex::called(const std::string& name) {
  static const std::vector<std::string> none;
  if (!isListed_) list();
  const auto found = names_.find(name);
  return found == names_.end() ? none : found->second;
}

void FileIndex::list() {
  isListed_ = true;
  const auto file = files_.hostFile(of_);
  if (!file) return;
  fs::path root = *file;
  for (const auto& part : fs::path(of_)) root = part.empty() ? root : root.parent_path();
  std::error_code failed;
  std::size_t listed = 0;
  fs::recursive_directory_iterator at(root, fs::directory_options::skip_permission_denied, failed), end;
  for (; !failed && at != end && listed < kMaxListed; at.increment(failed), ++listed) {
    const bool isFolder = at->is_directory(failed);
    if (isFolder && at->path().filename().string().starts_with('.')) at.disable_recursion_pending();
    if (isFolder || !isWanted(at->path().extension().string())) continue;
    names_[at->path().filename().string()].push_back(at->path().lexically_relative(root).generic_string());
  }
  const fs::path here = fs::path(of_).parent_path();
  for (auto& [name, files] : names_)
    std::sort(files.begin(), files.end(), [&](const std::string& a, const std::string& b) {
      const int inA = common(here, a), inB = common(here, b);
      return inA != inB ? inA > inB : a < b;
    });
}

}  // namespace spark::webots
