#pragma once
/// \file
/// Meshes and textures by name, read from the file server.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "image.h"
#include "meshes/visual_mesh.h"

namespace spark {
class Kernel;
}

namespace spark::camera {

using Mesh = meshes::VisualMesh;

/// Reads each file once, and again when it changed. What it returns lives as long as the store. A file that cannot be
/// read is logged once, and one whose pixels would be too many beside those of all others.
class MeshStore {
 public:
  /// `kernel` must outlive it.
  explicit MeshStore(Kernel& kernel) : kernel_(kernel) {}
  /// The mesh; nullptr if there is no such file, or it cannot be read.
  const Mesh* mesh(const std::string& resource);
  /// The image; nullptr for "", if there is no such file, or it cannot be read.
  const Image* image(const std::string& resource);

 private:
  template <class T>
  struct Known {
    std::uint64_t stamp = 0;  ///< of the file
    const T* value = nullptr;
  };
  std::optional<std::string> file(const std::string& resource) const;
  template <class T, class Read>
  const T* get(const std::string& resource, std::map<std::string, Known<T>>& known, std::deque<T>& all, Read read);

  Kernel& kernel_;
  static constexpr std::size_t kMostPixelBytes = std::size_t{256} << 20;  ///< of all images
  std::size_t pixelBytes_ = 0;
  std::deque<Mesh> allMeshes_;
  std::deque<Image> allImages_;
  std::map<std::string, Known<Mesh>> meshes_;
  std::map<std::string, Known<Image>> images_;
};

}  // namespace spark::camera
