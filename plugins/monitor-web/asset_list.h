#pragma once
/// \file
/// What viewers may fetch: the mesh files and textures that scenes have named, each by its number.

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stream/messages.h"

namespace spark::web {

/// A resource for viewers.
struct Asset {
  AssetKind kind = AssetKind::mesh;
  std::string resource;  ///< its name for the file server
  auto operator<=>(const Asset&) const = default;
};

/// Grows with each scene and forgets nothing, so a path means the same as long as the host runs. The paths of another
/// host differ, so browsers may cache what they fetch. Any thread.
class AssetList {
 public:
  static constexpr std::size_t kMost = 4096;  ///< further ones are not served
  AssetList();
  /// The path of a resource, such as `mesh/0f3a.../2`. "" for meshes that are no files, and if the list is full.
  std::string link(AssetKind kind, const std::string& resource);
  /// The same as a function, which refers to this object.
  AssetLink links();
  /// The asset of a path that link() has returned.
  std::optional<Asset> find(std::string_view path) const;

 private:
  const std::string token_;  ///< random; in all paths
  mutable std::mutex mutex_;
  std::vector<Asset> assets_;
  std::map<Asset, std::size_t> indices_;
};

}  // namespace spark::web
