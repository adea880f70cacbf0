#include "mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "spark/error.h"

namespace spark::mjcf {

namespace {
/// Files that a mesh file names, such as materials, are not opened: they would be any file of this machine.
struct NoFiles : Assimp::IOSystem {
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};
}  // namespace

engine::ShapeDescription readMesh(const std::string& name, const std::string& bytes) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // which owns it
  const std::size_t dot = name.rfind('.');
  const std::string format = dot == std::string::npos ? "" : name.substr(dot + 1);
  const aiScene* const scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices | aiProcess_SortByPType,
      format.c_str());
  if (!scene) throw Error(importer.GetErrorString());
  engine::ShapeDescription s;
  s.shape = engine::Shape::mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (mesh.mPrimitiveTypes != aiPrimitiveType_TRIANGLE) continue;
    const auto first = static_cast<std::uint32_t>(s.vertices.size() / 3);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      for (const float c : {mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z}) s.vertices.push_back(c);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned i = 0; i < 3; ++i) s.triangles.push_back(first + mesh.mFaces[f].mIndices[i]);
  }
  if (s.triangles.empty()) throw Error("expected triangles, found none");
  return s;
}

}  // namespace spark::mjcf
