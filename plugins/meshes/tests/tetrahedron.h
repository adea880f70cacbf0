#pragma once
/// \file
/// A tetrahedron in each format. It spans 0..1 along each axis.

#include <cstdint>
#include <string>

namespace spark::test {

inline const char* const kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

inline std::string stl() {
  std::string out(80, ' ');
  const auto put = [&out](const auto& v) { out.append(reinterpret_cast<const char*>(&v), sizeof v); };
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  put(std::uint32_t{4});
  for (const auto& f : faces) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const int corner : f)
      for (const float v : corners[corner]) put(v);
    put(std::uint16_t{0});
  }
  return out;
}

inline const char* const kDae = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";

/// `material`: JSON of its material; "": none.
inline std::string glb(const std::string& material = "") {
  std::string json = material.empty() ? "{" : R"({"materials":[)" + material + "],";
  json += R"("asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1)";
  json += material.empty() ? "" : R"(,"material":0)";
  json += R"(}]}],)"
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
          R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
          R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
          R"("buffers":[{"byteLength":72}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary;
  for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f})
    binary.append(reinterpret_cast<const char*>(&v), 4);
  for (const std::uint16_t i : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3})
    binary.append(reinterpret_cast<const char*>(&i), 2);
  std::string out = "glTF";
  const auto put = [&out](std::size_t v) {
    const auto n = static_cast<std::uint32_t>(v);
    out.append(reinterpret_cast<const char*>(&n), 4);
  };
  put(2), put(12 + 8 + json.size() + 8 + binary.size());
  put(json.size()), out += "JSON" + json;
  put(binary.size()), out.append("BIN\0", 4), out += binary;
  return out;
}

}  // namespace spark::test
