#include "mujoco_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "spark/random.h"

namespace spark {

namespace {

/// The mesh with these numbers that a node of this process has, or else a new one.
std::shared_ptr<const engine::Mesh> shared(engine::Mesh mesh) {
  static std::mutex mutex;
  static std::multimap<std::uint64_t, std::weak_ptr<const engine::Mesh>> all;  // by the hash of their numbers
  const auto bytes = [](const auto& numbers) {
    return std::string_view(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers.front()));
  };
  const std::uint64_t hash = hashBytes(bytes(mesh.triangles), hashBytes(bytes(mesh.vertices)));
  const std::lock_guard lock(mutex);
  for (auto [known, end] = all.equal_range(hash); known != end; ++known)
    if (auto same = known->second.lock(); same && *same == mesh) return same;
  std::erase_if(all, [](const auto& entry) { return entry.second.expired(); });
  auto out = std::make_shared<const engine::Mesh>(std::move(mesh));
  all.emplace(hash, out);
  return out;
}

}  // namespace

void MujocoMesh::describe(Description<MujocoMesh>& d) {
  engine::describeExtension(
      d, "What MuJoCo alone reads of the ConvexCollider above it: the mesh of which it makes the hull itself.");
  d.property("vertices", &MujocoMesh::vertices, &MujocoMesh::setVertices)
      .unit("m")
      .doc("x y z of each vertex, in the collider's frame. Setting it removes all triangles.");
  d.property("triangles", &MujocoMesh::triangles, &MujocoMesh::setTriangles)
      .min(0)
      .doc("Three vertex indices of each triangle, from 0. Without triangles MuJoCo makes them itself.");
}

std::vector<double> MujocoMesh::vertices() const {
  if (!mesh_) return {};
  return mesh_->vertices;
}

std::vector<std::int64_t> MujocoMesh::triangles() const {
  if (!mesh_) return {};
  return {mesh_->triangles.begin(), mesh_->triangles.end()};
}

void MujocoMesh::setVertices(std::vector<double> vertices) {
  if (vertices.size() % 3 != 0 ||
      !std::all_of(vertices.begin(), vertices.end(), [](double v) { return std::isfinite(v); }))
    throw Error(fmt::format("{}: expected three finite numbers a vertex, found {} numbers", path(), vertices.size()));
  take({std::move(vertices), {}});
}

void MujocoMesh::setTriangles(const std::vector<std::int64_t>& triangles) {
  engine::Mesh mesh{vertices(), {}};
  const auto count = static_cast<std::int64_t>(mesh.vertices.size() / 3);
  for (const std::int64_t t : triangles) {
    if (t < 0 || t >= count)
      throw Error(
          fmt::format("{}: a triangle names vertex {}, there are {}. Set the vertices first", path(), t, count));
    mesh.triangles.push_back(static_cast<std::uint32_t>(t));
  }
  if (triangles.size() % 3 != 0)
    throw Error(fmt::format("{}: expected three indices a triangle, found {}", path(), triangles.size()));
  take(std::move(mesh));
}

void MujocoMesh::take(engine::Mesh mesh) {
  const auto before = std::exchange(mesh_, shared(std::move(mesh)));  // which ends when it is in the model no more
  set<&mujoco::MeshNumbers::mesh>(mesh_->vertices.empty() ? nullptr : mesh_.get());
}

}  // namespace spark
