#include "mesh_message.h"

#include <fmt/format.h>

#include <cmath>

#include "spark/error.h"
#include "stream/stream_encoder.h"

namespace spark::web {

namespace {
void putCorner(std::string& out, const meshes::Vertex& v) {
  for (const float f :
       {v.position[0], v.position[1], v.position[2], v.normal[0], v.normal[1], v.normal[2], v.place[0], v.place[1]}) {
    if (!std::isfinite(f)) throw Error("expected finite numbers");
    putRaw(out, f);
  }
}
}  // namespace

std::string meshMessage(const meshes::VisualMesh& mesh, const AssetLink& link) {
  std::string head;
  std::size_t corners = 0;
  JsonWriter json(head, kWebJson);
  json.beginObject().key("parts").beginArray();
  for (const meshes::MeshPart& part : mesh.parts) {
    json.beginObject().member("material", part.material).member("corners", part.vertices.size()).endObject();
    corners += part.vertices.size();
  }
  json.endArray().key("materials").beginArray();
  for (const meshes::MeshMaterial& m : mesh.materials) {
    json.beginObject().member("name", m.name);
    writeLook(json, m.look, m.texture, link);
    json.endObject();
  }
  json.endArray().endObject();
  if (corners > kMostCorners)
    throw Error(fmt::format("expected at most {} triangles, found {}", kMostCorners / 3, corners / 3));

  head.resize((head.size() + 3) / 4 * 4, ' ');  // floats are aligned for their readers
  std::string out;
  out.reserve(4 + head.size() + 32 * corners);
  putRaw(out, static_cast<std::uint32_t>(head.size()));
  out += head;
  for (const meshes::MeshPart& part : mesh.parts)
    for (const meshes::Vertex& v : part.vertices) putCorner(out, v);
  return out;
}

}  // namespace spark::web
