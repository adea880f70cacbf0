#include "assimp_file.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <type_traits>

#include "apart.h"
#include "spark/error.h"
#include "spark/random.h"
#include "spark/state_stream.h"

namespace spark::meshes {

namespace {
/// Files that a mesh file names, such as materials, are not opened: they would be any file of this machine.
struct NoFiles : Assimp::IOSystem {
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// Leaves the readers of one format. Otherwise assimp, when they do not take a file, looks for another one by words in
/// it, and some of the others crash on damaged files. Throws Error if there is none.
void keepReadersOf(const std::string& format, Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string formats = fmt::format(" {} ", importer.GetImporterInfo(i)->mFileExtensions);
    if (!format.empty() && formats.find(' ' + format + ' ') != std::string::npos) continue;
    const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
    importer.UnregisterLoader(other.get());
  }
  if (importer.GetImporterCount() == 0)
    throw Error(fmt::format("expected a mesh file of a known kind, such as .obj, .stl, .dae, .glb or .msh, found '.{}'",
                            format));
}
MeshMaterial materialOf(const aiMaterial& from) {
  MeshMaterial out{from.GetName().C_Str(), {}, {}};
  if (out.name == AI_DEFAULT_MATERIAL_NAME) out.name.clear();
  const auto color = [&](const char* key, Color& to) {
    aiColor4D c;
    if (from.Get(key, 0, 0, c) == aiReturn_SUCCESS) to = {c.r, c.g, c.b, 1};
  };
  color("$clr.ambient", out.look.ambient);
  color("$clr.diffuse", out.look.diffuse);
  color("$clr.specular", out.look.specular);
  color("$clr.emissive", out.look.emission);
  float number = 0;
  if (from.Get(AI_MATKEY_OPACITY, number) == aiReturn_SUCCESS) out.look.diffuse.a = number;
  if (from.Get(AI_MATKEY_SHININESS, number) == aiReturn_SUCCESS)
    out.look.shininess = std::clamp<double>(number, 0, 128);
  aiString texture;
  // The names of textures inside of the file begin with a star.
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS && texture.C_Str()[0] != '*')
    out.texture = texture.C_Str();
  return out;
}

/// `toScene`: from the mesh's frame to that of the scene.
AssimpMesh meshOf(const aiMesh& from, const aiMatrix4x4& toScene) {
  AssimpMesh out{{}, {}, from.mMaterialIndex};
  const bool mirrored = toScene.Determinant() < 0;
  const aiMatrix3x3 normals = aiMatrix3x3(toScene).Inverse().Transpose();
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    const aiVector3D p = toScene * from.mVertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error("expected vertices of finite numbers");
    const aiVector3D n = from.HasNormals() ? (normals * from.mNormals[i]).NormalizeSafe() : aiVector3D();
    const aiVector3D t = from.HasTextureCoords(0) ? from.mTextureCoords[0][i] : aiVector3D();
    out.corners.push_back({{p.x, p.y, p.z}, {n.x, n.y, n.z}, {t.x, t.y}});
  }
  for (const aiFace& face : std::span(from.mFaces, from.mNumFaces))
    if (face.mNumIndices == 3) {
      out.triangles.insert(out.triangles.end(), face.mIndices, face.mIndices + 3);
      // A mirrored triangle is seen from its other side.
      if (mirrored) std::swap(out.triangles.end()[-1], out.triangles.end()[-2]);
    }
  return out;
}

/// Adds the meshes of a node and all below it. `above`: from the frame of its parent to that of the scene.
void addMeshes(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, std::vector<AssimpMesh>& out) {
  const aiMatrix4x4 toScene = above * node.mTransformation;
  for (const unsigned m : std::span(node.mMeshes, node.mNumMeshes))
    // A flag beside that of triangles says that some of them were one polygon.
    if (const aiMesh& mesh = *scene.mMeshes[m]; mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)
      out.push_back(meshOf(mesh, toScene));
  for (const aiNode* child : std::span(node.mChildren, node.mNumChildren)) addMeshes(scene, *child, toScene, out);
}

/// Names the faces of a file that are no triangles: of one corner, or of two.
std::vector<std::string> leftOutOf(const aiScene& scene) {
  std::array<std::size_t, 3> faces{};  // by number of corners
  for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes))
    for (const aiFace& face : std::span(mesh->mFaces, mesh->mNumFaces))
      if (face.mNumIndices < faces.size()) ++faces[face.mNumIndices];
  std::vector<std::string> out;
  if (faces[1]) out.push_back(fmt::format("{} point{}", faces[1], faces[1] == 1 ? "" : "s"));
  if (faces[2]) out.push_back(fmt::format("{} line{}", faces[2], faces[2] == 1 ? "" : "s"));
  return out;
}

AssimpFile readHere(const std::string& format, const std::string& bytes) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // which owns it
  keepReadersOf(format, importer);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* const scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType,
      format.c_str());
  if (!scene) {
    const std::string error = importer.GetErrorString();
    if (error == std::bad_alloc().what()) throw std::bad_alloc();  // of which it keeps the text alone
    throw Error(error);
  }
  AssimpFile out;
  for (unsigned m = 0; m < scene->mNumMaterials; ++m) out.materials.push_back(materialOf(*scene->mMaterials[m]));
  if (scene->mRootNode) addMeshes(*scene, *scene->mRootNode, {}, out.meshes);
  out.leftOut = leftOutOf(*scene);
  return out;
}

// ---- from the process that reads to the one that asked ----

template <class T>
std::string_view bytesOf(const T* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

/// The values that bytesOf() made bytes of.
template <class T>
std::vector<T> valuesOf(const std::string& bytes) {
  std::vector<T> out(bytes.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

std::string written(const AssimpFile& file) {
  StateWriter out(true);
  out.write(static_cast<std::uint64_t>(file.meshes.size()));
  for (const AssimpMesh& mesh : file.meshes) {
    out.write(bytesOf(mesh.corners.data(), mesh.corners.size()));
    out.write(bytesOf(mesh.triangles.data(), mesh.triangles.size()));
    out.write(static_cast<std::uint64_t>(mesh.material));
  }
  out.write(static_cast<std::uint64_t>(file.materials.size()));
  for (const MeshMaterial& material : file.materials) {
    out.write(material.name);
    out.write(bytesOf(&material.look, 1));
    out.write(material.texture);
  }
  out.write(static_cast<std::uint64_t>(file.leftOut.size()));
  for (const std::string& what : file.leftOut) out.write(what);
  return out.take();
}

/// The last files that could not be read, of all threads: finding that out may take seconds each time, in which the
/// simulation waits, and each robot that comes with such a file would cost them again.
class KnownFailures {
 public:
  /// Throws Error with what add() was given for this file.
  void throwIfKnown(const std::string& format, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t hash = hashOf(format, bytes);
    for (const Failure& f : all_)
      if (f.hash == hash && f.size == bytes.size()) throw Error(f.why);
  }
  void add(const std::string& format, const std::string& bytes, const char* why) {
    const std::lock_guard lock(mutex_);
    if (all_.size() == kMost) all_.pop_front();
    all_.push_back({hashOf(format, bytes), bytes.size(), why});
  }

 private:
  static constexpr std::size_t kMost = 64;
  struct Failure {
    std::uint64_t hash;
    std::size_t size;
    std::string why;
  };
  static std::uint64_t hashOf(const std::string& format, const std::string& bytes) {
    return hashBytes(bytes, hashBytes(format));
  }
  std::mutex mutex_;
  std::deque<Failure> all_;
};

AssimpFile readBack(const std::string& bytes) {
  StateReader in(bytes);
  AssimpFile out;
  for (std::size_t n = in.readCount(); n > 0; --n) {
    AssimpMesh& mesh = out.meshes.emplace_back();
    mesh.corners = valuesOf<AssimpMesh::Corner>(in.readString());
    mesh.triangles = valuesOf<std::uint32_t>(in.readString());
    mesh.material = static_cast<std::uint32_t>(in.readInteger());
  }
  for (std::size_t n = in.readCount(); n > 0; --n) {
    MeshMaterial& material = out.materials.emplace_back();
    material.name = in.readString();
    const auto looks = valuesOf<IMaterial::Look>(in.readString());
    if (looks.size() != 1) throw Error("expected the look of a material");
    material.look = looks.front();
    material.texture = in.readString();
  }
  for (std::size_t n = in.readCount(); n > 0; --n) out.leftOut.push_back(in.readString());
  for (const AssimpMesh& mesh : out.meshes) {
    if (mesh.material >= out.materials.size() || mesh.triangles.size() % 3 != 0)
      throw Error("expected triangles and their material");
    for (const std::uint32_t i : mesh.triangles)
      if (i >= mesh.corners.size()) throw Error("expected indices of vertices in faces");
  }
  return out;
}
}  // namespace

std::string formatOf(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string format = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char& c : format) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return format;
}

AssimpFile readAssimpFile(const std::string& format, const std::string& bytes) {
  static KnownFailures known;
  known.throwIfKnown(format, bytes);
  try {
    return readBack(doneApart([&] { return written(readHere(format, bytes)); }));
  } catch (const Error& e) {
    known.add(format, bytes, e.what());
    throw;
  }
}

}  // namespace spark::meshes
