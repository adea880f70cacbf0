#include "mesh_importer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <string>

#include "api/provides.h"
#include "spark/access.h"
#include "spark/plugin.h"

namespace spark {

namespace {

constexpr std::array kEndings{".obj", ".gltf", ".glb", ".dae", ".stl", ".ply", ".3ds"};

std::string lowerCase(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// What the nodes of "models/red chair.obj" are called: "red_chair"; a number is added if the name is taken.
std::string nameFor(std::string_view file, const Node& root) {
  std::string stem(file.substr(file.find_last_of('/') + 1));
  stem.resize(std::min(stem.size(), stem.find_last_of('.')));
  for (char& c : stem)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  if (stem.empty()) stem = "model";
  std::string name = stem;
  for (int i = 2; root.find(name); ++i) name = fmt::format("{}_{}", stem, i);
  return name;
}

/// The number of an argument; scene files give it as text.
std::optional<double> numberOf(const Value& argument) {
  if (argument.isNumber()) return argument.toNumber();
  const std::string text = argument.plain();
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

struct Wanted {
  List scale;
  bool collides = true;
};

Wanted read(std::string_view file, const List& arguments) {
  Wanted out;
  for (const Value& argument : arguments) {
    const std::optional<double> number = numberOf(argument);
    if (number && out.collides && out.scale.size() < 3)
      out.scale.push_back(*number);
    else if (argument.plain() == "shown" && &argument == &arguments.back())
      out.collides = false;
    else
      throw Error(fmt::format("cannot import '{}': expected a scale of one number or three, and 'shown', found '{}'",
                              file, argument.plain()));
  }
  if (out.scale.size() == 1) out.scale.resize(3, out.scale.front());
  if (out.scale.size() == 2)
    throw Error(fmt::format("cannot import '{}': expected a scale of one number or three, found two", file));
  return out;
}

}  // namespace

void MeshImporter::describe(Description<MeshImporter>& d) {
  d.doc(
      "Imports 3D models: OBJ, glTF, COLLADA, STL, PLY, 3DS. Arguments: a scale of one number or three; 'shown': it "
      "does not collide.");
  d.implements<ISceneImporter>();
}

bool MeshImporter::recognises(std::string_view, std::string_view file) const {
  const std::string name = lowerCase(file);
  return std::any_of(kEndings.begin(), kEndings.end(), [&](const char* ending) { return name.ends_with(ending); });
}

void MeshImporter::import(std::string_view file, Node& root, const List& arguments) {
  const Wanted wanted = read(file, arguments);
  Node& place = *root.create("Transform", nameFor(file, root)).asNode();
  Leaf& shape = place.create("StaticMesh", "shape");
  callMethod(shape, "load", List{std::string(file)});
  if (!wanted.scale.empty()) callMethod(shape, "setScale", wanted.scale);
  // Without a world there is nothing to collide with.
  const auto hasWorld = [&] {
    for (const Node* up = &root; up; up = up->parent())
      for (const auto& child : up->children())
        if (child->classObject()->isOrOffers("World")) return true;
    return false;
  };
  if (!wanted.collides || !hasWorld() || !provides(kernel(), "TriMeshCollider")) return;
  Node& space = *place.create("Space", "space").asNode();
  Leaf& collider = space.create("TriMeshCollider", "collider");
  if (!wanted.scale.empty()) setProperty(collider, "scale", wanted.scale);
  setProperty(collider, "mesh", std::string(file));
}

}  // namespace spark

SPARK_PLUGIN("scene-meshes", "1.0",
             "Parts of scenes made by programs for 3D models: OBJ, glTF, COLLADA, STL and others.", spark::MeshImporter)
