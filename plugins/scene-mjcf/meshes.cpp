#include "meshes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "meshes/kept_hulls.h"

namespace spark::mjcf {

namespace {

/// The faces of a mesh that is written in the model.
std::vector<std::uint32_t> readFaces(Attributes& a, std::size_t vertices) {
  std::vector<std::uint32_t> out;
  const auto numbers = a.numbers("face", 3, kMaxMeshNumbers);
  if (!numbers) return out;
  if (numbers->size() % 3 != 0)
    throw a.element().error(
        fmt::format("expected three numbers for each triangle of 'face', found {}", numbers->size()));
  for (const double n : *numbers) {
    if (n < 0 || n >= double(vertices) || n != std::floor(n))
      throw a.element().error(fmt::format("expected indices of the {} vertices for 'face', found {}", vertices, n));
    out.push_back(static_cast<std::uint32_t>(n));
  }
  return out;
}

}  // namespace

void Meshes::add(Attributes& a, const std::string& folder, const Compiler& compiler) {
  Asset m;
  m.from = a.element();
  m.folder = folder;
  m.file = compiler.fileName(a.text("file"));
  if (auto vertices = a.numbers("vertex", 12, kMaxMeshNumbers)) m.vertices = std::move(*vertices);
  if (m.vertices.size() % 3 != 0)
    throw m.from.error(fmt::format("expected three numbers for each vertex, found {}", m.vertices.size()));
  m.faces = readFaces(a, m.vertices.size() / 3);
  a.take("scale", m.scale);
  a.take("refpos", m.origin);
  if (std::array<double, 4> q{}; a.take("refquat", q)) {
    const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
    if (!(rotation.norm() > 1e-10)) throw m.from.error("expected a quaternion that is not 0 for 'refquat'");
    m.rotation = rotation.normalized().toRotationMatrix();
  }
  std::string name = a.text("name");
  if (name.empty()) {
    const std::size_t slash = m.file.rfind('/'), start = slash == std::string::npos ? 0 : slash + 1;
    name = m.file.substr(start, m.file.rfind('.') - start);
  }
  // What newer versions add.
  m.inertia = a.word("inertia", {"", "legacy", "exact", "convex", "shell"}, "");
  a.ignore({"smoothnormal", "texcoord", "normal", "maxhullvert", "content_type"});
  a.finish();
  assets_[name] = std::move(m);
}

const Mesh& Meshes::get(Attributes& a, Unsupported& unsupported) {
  const std::string name = a.text("mesh");
  const auto found = assets_.find(name);
  if (found == assets_.end()) throw a.element().error(fmt::format("there is no <mesh> '{}'", name));
  const Mesh& mesh = loaded(found->second, unsupported);
  numbers_ += mesh.surface->vertices.size() + mesh.surface->triangles.size();
  if (numbers_ > kMaxMeshNumbers)
    throw LimitError(
        fmt::format("{}: the meshes of all geoms have more than {} numbers", a.element().where(), kMaxMeshNumbers));
  return mesh;
}

/// One that cannot be loaded is not tried again.
const Mesh& Meshes::loaded(Asset& m, Unsupported& unsupported) {
  if (!m.failure.empty()) throw Error(m.failure);
  try {
    if (!m.loaded) load(m, unsupported);
  } catch (const LimitError&) {
    throw;
  } catch (const Error& e) {
    m.failure = e.what();
    throw;
  }
  return *m.loaded;
}

/// As the file or the element has it. A mesh without faces has no triangles.
engine::Mesh Meshes::surfaceOf(const Asset& m) const {
  if (!m.vertices.empty()) return {m.vertices, m.faces};
  if (m.file.empty()) throw m.from.error("expected an attribute 'file' or 'vertex'");
  try {
    return read_(std::filesystem::path(m.folder + m.file).lexically_normal().string());
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot read the mesh '{}'", m.from.where(), m.file), e);
  }
}

void Meshes::load(Asset& m, Unsupported& unsupported) {
  engine::Mesh surface = surfaceOf(m);
  // In single precision at each stage, as in MuJoCo.
  const auto rounded = [](const Vec3& at) { return Vec3(at.cast<float>().cast<double>()); };
  std::vector<double>& v = surface.vertices;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
    Eigen::Map<Vec3> at(v.data() + i);
    const Vec3 moved = rounded(rounded(at) - m.origin);
    at = rounded(rounded(m.rotation.transpose() * moved).cwiseProduct(m.scale));
    if (!at.allFinite()) throw m.from.error("expected vertices of finite numbers");
  }
  const auto read = std::make_shared<const engine::Mesh>(std::move(surface));
  Mesh mesh;
  try {
    mesh.hull = meshes::keptHullOf(read);
  } catch (const Error& e) {
    if (read->triangles.empty()) throw Error(m.from.where() + ": the mesh has no convex hull", e);
    unsupported.add(m.from, "a flat <mesh> has no convex hull: its triangles collide, on bodies that do not move");
  }
  mesh.surface = read->triangles.empty() ? mesh.hull : read;
  mesh.weighsAsHull = m.inertia == "convex";
  if (m.inertia == "exact" || m.inertia == "convex") mesh.inertia = MeshInertia::exact;
  if (m.inertia == "legacy") mesh.inertia = MeshInertia::legacy;
  if (m.inertia == "shell") mesh.inertia = MeshInertia::shell;
  if (mesh.hull) surfaces_[mesh.hull.get()] = read;
  m.loaded = std::move(mesh);
}

}  // namespace spark::mjcf
