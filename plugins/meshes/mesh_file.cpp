#include "mesh_file.h"

#include <tiny_obj_loader.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <span>
#include <sstream>

#include "assimp_file.h"
#include "spark/error.h"

namespace spark::meshes {

using engine::Mesh;

namespace {
/// MuJoCo's format: the numbers of vertices, normals, texture coordinates and faces, then these arrays, in the byte
/// order of x86 (MuJoCo's documentation, "MSH file").
Mesh readMsh(const std::string& bytes) {
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
  Mesh s;
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
  Mesh mesh;
  void addFace(std::span<const tinyobj::index_t> corners) {
    const auto vertices = static_cast<long>(mesh.vertices.size() / 3);
    const auto vertex = [vertices](const tinyobj::index_t& corner) {
      const int number = corner.vertex_index;
      const long v = number < 0 ? vertices + number : number - 1L;  // counted from 1, or backwards from the last one
      if (v < 0 || v >= vertices)
        throw Error(fmt::format("expected a face of its {} vertices, found number {}", vertices, number));
      return static_cast<std::uint32_t>(v);
    };
    for (const tinyobj::index_t& corner : corners) vertex(corner);
    for (std::size_t i = 2; i < corners.size(); ++i)
      for (const std::size_t c : {std::size_t{0}, i - 1, i}) mesh.triangles.push_back(vertex(corners[c]));
  }
};

/// Reads the lines of an OBJ file that its reader would not report.
class ObjLines {
 public:
  /// Throws Error for a vertex that is not three finite numbers, which the reader would take for 0.
  explicit ObjLines(std::string_view text) {
    for (std::size_t line = 1; !text.empty(); ++line) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      read(text.substr(0, end), line);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }
  /// What has no triangles: "2 lines".
  std::vector<std::string> leftOut() const {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < std::size(kOther); ++i)
      if (counts_[i]) out.push_back(fmt::format("{} {}{}", counts_[i], kOther[i].second, counts_[i] == 1 ? "" : "s"));
    return out;
  }

 private:
  static constexpr std::pair<std::string_view, const char*> kOther[] = {
      {"p", "point"}, {"l", "line"}, {"curv", "curve"}, {"curv2", "flat curve"}, {"surf", "free-form surface"}};

  void read(std::string_view rest, std::size_t line) {
    const auto skipBlanks = [&rest] { rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r"), rest.size())); };
    skipBlanks();
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r"));
    for (std::size_t i = 0; i < std::size(kOther); ++i) counts_[i] += word == kOther[i].first;
    if (word != "v" || word.size() == rest.size()) return;
    rest.remove_prefix(1);
    for (int i = 0; i < 3; ++i) {
      skipBlanks();
      if (rest.starts_with('+')) rest.remove_prefix(1);
      double number = 0;
      const auto [next, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
      if (error != std::errc() || !std::isfinite(number))
        throw Error(fmt::format("line {}: expected three finite numbers of a vertex, found '{}'", line,
                                rest.substr(0, std::min<std::size_t>(rest.find_first_of(" \t\r"), 40))));
      rest.remove_prefix(static_cast<std::size_t>(next - rest.data()));
    }
  }
  std::array<std::size_t, std::size(kOther)> counts_{};
};

Mesh readObj(const std::string& bytes, std::vector<std::string>& leftOut) {
  leftOut = ObjLines(bytes).leftOut();
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* file, float x, float y, float z, float) {
    for (const float c : {x, y, z}) {
      if (!std::isfinite(c)) throw Error("expected finite numbers");
      static_cast<ObjFile*>(file)->mesh.vertices.push_back(c);
    }
  };
  callbacks.index_cb = [](void* file, tinyobj::index_t* corners, int count) {
    static_cast<ObjFile*>(file)->addFace({corners, static_cast<std::size_t>(count)});
  };
  ObjFile out;
  std::istringstream stream(bytes);
  std::string warning, error;
  tinyobj::LoadObjWithCallback(stream, callbacks, &out, nullptr, &warning, &error);
  if (out.mesh.vertices.empty()) throw Error("expected vertices, found none");
  return std::move(out.mesh);
}

/// Drops the vertices that no triangle has, such as those of lines.
void keepCornersOfTriangles(Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size() / 3);
  for (const std::uint32_t i : mesh.triangles) used[i] = true;
  std::vector<std::uint32_t> number(used.size());  // by the former one
  std::vector<double> vertices;
  for (std::size_t i = 0; i < used.size(); ++i) {
    number[i] = static_cast<std::uint32_t>(vertices.size() / 3);
    if (used[i])
      vertices.insert(vertices.end(), {mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]});
  }
  mesh.vertices = std::move(vertices);
  for (std::uint32_t& i : mesh.triangles) i = number[i];
}

}  // namespace

Mesh readMesh(const std::string& name, const std::string& bytes, std::vector<std::string>* leftOut) {
  const std::string format = formatOf(name);
  std::vector<std::string> notRead;
  Mesh s;
  if (format == "msh") {
    s = readMsh(bytes);
  } else if (format == "obj") {
    s = readObj(bytes, notRead);
  } else {
    AssimpFile file = readAssimpFile(format, bytes);
    for (const AssimpMesh& mesh : file.meshes) {
      const auto first = static_cast<std::uint32_t>(s.vertices.size() / 3);
      for (const AssimpMesh::Corner& corner : mesh.corners)
        s.vertices.insert(s.vertices.end(), std::begin(corner.position), std::end(corner.position));
      for (const std::uint32_t i : mesh.triangles) s.triangles.push_back(first + i);
    }
    if (s.triangles.empty()) throw Error("expected triangles, found none");
    notRead = std::move(file.leftOut);
  }
  if (!notRead.empty() && !s.triangles.empty()) keepCornersOfTriangles(s);
  if (leftOut) leftOut->insert(leftOut->end(), notRead.begin(), notRead.end());
  return s;
}

}  // namespace spark::meshes
