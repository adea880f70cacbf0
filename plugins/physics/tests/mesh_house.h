#pragma once
/// \file
/// A physics house with files, and mesh files to load.

#include "physics_house.h"
#include "temporary_folder.h"

namespace spark::test {

/// A bowl as an OBJ file: a paraboloid of 1 m radius and 0.5 m height, whose lowest point is the origin.
inline std::string bowl(int rings = 12, int sectors = 24) {
  std::string out = "# a bowl\nv 0 0 0\n";
  for (int ring = 1; ring <= rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const double r = double(ring) / rings, angle = 2 * kPi * sector / sectors;
      out += fmt::format("v {:.6f} {:.6f} {:.6f}\n", r * std::cos(angle), r * std::sin(angle), r * r / 2);
    }
  const auto at = [&](int ring, int sector) { return ring == 0 ? 1 : 2 + (ring - 1) * sectors + sector % sectors; };
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      out += fmt::format("f {} {} {}\n", at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1));
      if (ring > 0)
        out += fmt::format("f {} {} {}\n", at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
    }
  return out;
}

/// A box from `low` to `high` as an OBJ file of six quadrangles.
inline std::string boxFile(const Vec3& low, const Vec3& high) {
  std::string out;
  for (int i = 0; i < 8; ++i)
    out +=
        fmt::format("v {} {} {}\n", i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  return out + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// Files of a folder are resources by their names in it.
struct MeshHouse : PhysicsHost {
  TemporaryFolder folder;
  MeshHouse() {
    kernel.plugins().use("files");
    kernel.create("FileServer", "/sys/server/file");
    Leaf& own = kernel.create("DirectoryFileSystem", "/sys/server/file/own");
    call(own, "setPath", {folder.path().string()});
  }
  void ground() { scene.create("PlaneCollider", "ground"); }
  /// Adds drag, so that the body comes to rest.
  static void damp(Node& thing) {
    setProperty(*thing.find("body"), "linearDamping", 0.5);
    setProperty(*thing.find("body"), "angularDamping", 0.05);
  }
  /// A surface that does not bounce.
  static void calm(Leaf& collider) {
    setProperty(collider.asNode()->create("ContactJointHandler", "surface"), "contactBounceMode", false);
  }
};

}  // namespace spark::test
