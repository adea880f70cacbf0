#include "mesh_pool.h"

#include <algorithm>

#include "spark/random.h"

namespace spark::physics {

namespace {

template <class T>
std::string_view bytesOf(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

}  // namespace

MeshPool::Shared MeshPool::share(engine::Mesh mesh) {
  const std::uint64_t hash = hashBytes(bytesOf(mesh.triangles), hashBytes(bytesOf(mesh.vertices)));
  for (auto [known, end] = all_.equal_range(hash); known != end; ++known)
    if (Shared same = known->second.lock(); same && *same == mesh) return same;
  if (all_.size() + named_.size() + hulls_.size() >= sweepAt_) {
    const auto ended = [](const auto& entry) { return entry.second.expired(); };
    std::erase_if(all_, ended);
    std::erase_if(named_, ended);
    std::erase_if(hulls_, [](const auto& entry) { return entry.second.points.expired(); });
    sweepAt_ = 2 * (all_.size() + named_.size() + hulls_.size()) + 16;
  }
  auto out = std::make_shared<const engine::Mesh>(std::move(mesh));
  all_.emplace(hash, out);
  return out;
}

MeshPool::Shared MeshPool::get(const std::string& name, const std::function<engine::Mesh()>& make) {
  if (const auto known = named_.find(name); known != named_.end())
    if (Shared mesh = known->second.lock()) return mesh;
  ++loads_;
  Shared mesh = share(make());
  named_[name] = mesh;
  return mesh;
}

MeshPool::Shared MeshPool::hullOf(const Shared& points, const std::function<engine::Mesh()>& make) {
  // Points that are still there are the same: no others have their address.
  if (const auto known = hulls_.find(points.get()); known != hulls_.end() && !known->second.points.expired())
    if (Shared hull = known->second.hull.lock()) return hull;
  Shared hull = share(make());
  hulls_[points.get()] = {points, hull};
  return hull;
}

std::size_t MeshPool::count() const {
  return static_cast<std::size_t>(
      std::count_if(all_.begin(), all_.end(), [](const auto& entry) { return !entry.second.expired(); }));
}

}  // namespace spark::physics
