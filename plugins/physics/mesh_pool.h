#pragma once
/// \file
/// The meshes of a world.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "api/shape.h"

namespace spark::physics {

/// Keeps each mesh of a world once, as long as a shape has it: a thousand chairs share the triangles of one, and
/// engines and rays make what they need of a mesh once as well (engine::MadeOf).
class MeshPool {
 public:
  using Shared = std::shared_ptr<const engine::Mesh>;
  /// The mesh with these numbers.
  Shared share(engine::Mesh mesh);
  /// The mesh that `make` made under this name, while a shape has it; otherwise what it makes now.
  Shared get(const std::string& name, const std::function<engine::Mesh()>& make);
  /// The hull that `make` made of these points, which share() returned, while a shape has it; otherwise what it makes
  /// now.
  Shared hullOf(const Shared& points, const std::function<engine::Mesh()>& make);
  /// How often `make` was called.
  std::int64_t loads() const { return loads_; }
  /// Meshes that shapes have.
  std::size_t count() const;

 private:
  using Weak = std::weak_ptr<const engine::Mesh>;
  std::map<std::string, Weak, std::less<>> named_;
  std::multimap<std::uint64_t, Weak> all_;  ///< by the hash of their numbers
  struct Hull {
    Weak points, hull;
  };
  std::map<const engine::Mesh*, Hull> hulls_;  ///< by their points
  std::int64_t loads_ = 0;
  std::size_t sweepAt_ = 16;  ///< number of entries at which those of ended meshes are removed
};

}  // namespace spark::physics
