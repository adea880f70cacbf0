#include "mesh_store.h"

#include "api/files.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark::camera {

std::optional<std::string> MeshStore::file(const std::string& resource) const {
  auto* files = kernel_.root().find<IFileServer>();
  try {
    if (files && files->exists(resource)) return files->read(resource);
  } catch (const Error&) {
    // A name that is no resource, such as one with "..".
  }
  return {};
}

template <class T, class Read>
const T* MeshStore::get(const std::string& resource, std::map<std::string, Known<T>>& known, std::deque<T>& all,
                        Read read) {
  // Names may come from a client: only files that exist are remembered.
  auto* files = kernel_.root().find<IFileServer>();
  std::uint64_t stamp = 0;
  try {
    stamp = files ? files->stamp(resource) : 0;
    if (stamp == 0) return nullptr;
    if (const auto found = known.find(resource); found != known.end() && found->second.stamp == stamp)
      return found->second.value;
    Known<T>& entry = known[resource] = {stamp, nullptr};
    return entry.value = &all.emplace_back(read(files->read(resource)));
  } catch (const Error& e) {
    if (stamp != 0) kernel_.log().warning("cameras do not show '{}': {}", resource, e.what());
    return nullptr;
  }
}

const Mesh* MeshStore::mesh(const std::string& resource) {
  return get(resource, meshes_, allMeshes_, [&](const std::string& bytes) {
    return meshes::readVisualMesh(resource, bytes, [this](const std::string& name) { return file(name); });
  });
}

const Image* MeshStore::image(const std::string& resource) {
  if (resource.empty()) return nullptr;
  return get(resource, images_, allImages_, [this](const std::string& bytes) {
    Image image = readPng(bytes, kMostPixelBytes - pixelBytes_);
    pixelBytes_ += image.pixels.size();
    return image;
  });
}

}  // namespace spark::camera
