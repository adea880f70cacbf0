#include "mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <span>
#include <sstream>

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

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

/// MuJoCo's format: the numbers of vertices, normals, texture coordinates and faces, then these arrays, in the byte
/// order of x86 (MuJoCo's documentation, "MSH file").
engine::ShapeDescription readMsh(const std::string& bytes) {
  std::array<std::int32_t, 4> counts{};
  constexpr std::size_t kHeader = sizeof counts;
  if (bytes.size() < kHeader)
    throw Error(fmt::format("expected a header of {} bytes, found {}", kHeader, bytes.size()));
  std::memcpy(counts.data(), bytes.data(), kHeader);
  std::size_t expected = kHeader;
  const std::size_t numbers[] = {3, 3, 2, 3};
  for (std::size_t i = 0; i < 4; ++i) {
    if (counts[i] < 0) throw Error("expected numbers of 0 or more in the header");
    expected += 4 * numbers[i] * static_cast<std::size_t>(counts[i]);
  }
  if (bytes.size() != expected) throw Error(fmt::format("expected {} bytes, found {}", expected, bytes.size()));
  engine::ShapeDescription s;
  const auto vertices = static_cast<std::size_t>(counts[0]), faces = static_cast<std::size_t>(counts[3]);
  for (std::size_t i = 0; i < 3 * vertices; ++i) {
    float v = 0;
    std::memcpy(&v, bytes.data() + kHeader + 4 * i, 4);
    if (!std::isfinite(v)) throw Error("expected finite numbers");
    s.vertices.push_back(v);
  }
  for (std::size_t i = 0; i < 3 * faces; ++i) {
    std::uint32_t v = 0;
    std::memcpy(&v, bytes.data() + bytes.size() - 12 * faces + 4 * i, 4);
    if (v >= vertices) throw Error(fmt::format("expected indices of the {} vertices in faces, found {}", vertices, v));
    s.triangles.push_back(v);
  }
  if (s.vertices.empty()) throw Error("expected vertices, found none");
  return s;
}

/// Vertices and faces of an OBJ file, whose polygons become fans of triangles.
struct ObjFile {
  engine::ShapeDescription shape;
  void addFace(std::span<const tinyobj::index_t> corners) {
    const auto vertices = static_cast<long>(shape.vertices.size() / 3);
    const auto vertex = [vertices](const tinyobj::index_t& corner) {
      const int number = corner.vertex_index;
      const long v = number < 0 ? vertices + number : number - 1L;  // counted from 1, or backwards from the last one
      if (v < 0 || v >= vertices)
        throw Error(fmt::format("expected a face of its {} vertices, found number {}", vertices, number));
      return static_cast<std::uint32_t>(v);
    };
    for (const tinyobj::index_t& corner : corners) vertex(corner);
    for (std::size_t i = 2; i < corners.size(); ++i)
      for (const std::size_t c : {std::size_t{0}, i - 1, i}) shape.triangles.push_back(vertex(corners[c]));
  }
};

engine::ShapeDescription readObj(const std::string& bytes) {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* file, float x, float y, float z, float) {
    for (const float c : {x, y, z}) {
      if (!std::isfinite(c)) throw Error("expected finite numbers");
      static_cast<ObjFile*>(file)->shape.vertices.push_back(c);
    }
  };
  callbacks.index_cb = [](void* file, tinyobj::index_t* corners, int count) {
    static_cast<ObjFile*>(file)->addFace({corners, static_cast<std::size_t>(count)});
  };
  ObjFile out;
  std::istringstream stream(bytes);
  std::string warning, error;
  tinyobj::LoadObjWithCallback(stream, callbacks, &out, nullptr, &warning, &error);
  if (out.shape.vertices.empty()) throw Error("expected vertices, found none");
  out.shape.shape = engine::Shape::mesh;
  return std::move(out.shape);
}

}  // namespace

engine::ShapeDescription readMesh(const std::string& name, const std::string& bytes) {
  const std::size_t dot = name.rfind('.');
  std::string format = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char& c : format) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  if (format == "msh") return readMsh(bytes);
  if (format == "obj") return readObj(bytes);
  engine::ShapeDescription s;
  s.shape = engine::Shape::mesh;
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // which owns it
  const aiScene* const scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices | aiProcess_SortByPType,
      format.c_str());
  if (!scene) throw Error(importer.GetErrorString());
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
