#include "asset_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "api/credentials.h"

namespace spark::web {

namespace {
/// The formats of mesh files that can be shown.
constexpr std::array<std::string_view, 5> kEndings{".obj", ".stl", ".dae", ".glb", ".msh"};

bool isMeshFile(std::string_view name) {
  std::string ending(name.substr(name.size() - std::min<std::size_t>(name.size(), 4)));
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

const char* folderOf(AssetKind kind) { return kind == AssetKind::mesh ? "mesh" : "texture"; }
}  // namespace

AssetList::AssetList() : token_(makeToken()) {}

std::string AssetList::link(AssetKind kind, const std::string& resource) {
  if (kind == AssetKind::mesh && !isMeshFile(resource)) return {};
  const std::lock_guard lock(mutex_);
  const Asset asset{kind, resource};
  auto at = indices_.find(asset);
  if (at == indices_.end()) {
    if (assets_.size() >= kMost) return {};
    at = indices_.emplace(asset, assets_.size()).first;
    assets_.push_back(asset);
  }
  return fmt::format("{}/{}/{}", folderOf(kind), token_, at->second);
}

AssetLink AssetList::links() {
  return [this](AssetKind kind, const std::string& resource) { return link(kind, resource); };
}

std::optional<Asset> AssetList::find(std::string_view path) const {
  const std::size_t slash = path.rfind('/');
  if (slash == path.npos) return {};
  const std::string_view number = path.substr(slash + 1);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (error != std::errc() || end != number.data() + number.size()) return {};
  const std::lock_guard lock(mutex_);
  if (index >= assets_.size()) return {};
  const Asset& asset = assets_[index];
  if (path.substr(0, slash) != fmt::format("{}/{}", folderOf(asset.kind), token_)) return {};
  return asset;
}

}  // namespace spark::web
