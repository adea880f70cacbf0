#include "materials.h"

#include <charconv>
#include <optional>

namespace spark {

void MaterialSolid::describe(Description<MaterialSolid>& d) {
  using M = MaterialSolid;
  d.doc("A material of one colour, for viewers.");
  d.implements<IMaterial>();
  d.property("ambient", &M::shown<Color, &M::ambient_>, &M::show<Color, &M::ambient_>).doc("Colour in ambient light.");
  d.property("diffuse", &M::shown<Color, &M::diffuse_>, &M::show<Color, &M::diffuse_>).doc("Colour in direct light.");
  d.property("specular", &M::shown<Color, &M::specular_>, &M::show<Color, &M::specular_>)
      .doc("Colour of its highlights.");
  d.property("emission", &M::shown<Color, &M::emission_>, &M::show<Color, &M::emission_>)
      .doc("Colour of emitted light.");
  d.property("shininess", &M::shown<double, &M::shininess_>, &M::show<double, &M::shininess_>)
      .unit("1")
      .range(0, 128)
      .doc("Sharpness of highlights.");
  d.property("depthCheck", &M::depthCheck_).doc("Hidden by objects in front of it.");
}

void Material2DTexture::describe(Description<Material2DTexture>& d) {
  d.doc("A material with a picture on it, for viewers.");
  d.property("diffuseTexture", &Material2DTexture::texture, &Material2DTexture::setTexture)
      .doc("Resource name of the picture, a PNG file that multiplies the colours; empty: none.");
}

void MaterialServer::describe(Description<MaterialServer>& d) {
  d.doc("Holds the materials that scenes refer to by name.");
  d.method("define", &MaterialServer::define)
      .parameters({"name", "diffuse"})
      .doc("Creates or changes a material of one colour.");
  d.method("resetMaterials", &MaterialServer::reset).doc("Removes all materials and creates one named 'default'.");
}

void MaterialServer::define(const std::string& name, Color diffuse) {
  Leaf* material = child(name);
  if (!material) material = &create("MaterialSolid", name);
  setProperty(*material, "diffuse", Convert<Color>::to(diffuse));
}

void MaterialServer::reset() {
  removeChildren();
  create("MaterialSolid", "default");
}

namespace {
/// The colour of a name such as "rgb22bb22", which importers give to materials without one.
std::optional<Color> colorOf(std::string_view name) {
  unsigned rgb = 0;
  const char* const end = name.data() + name.size();
  if (name.size() != 9 || !name.starts_with("rgb")) return std::nullopt;
  if (const auto read = std::from_chars(name.data() + 3, end, rgb, 16); read.ec != std::errc() || read.ptr != end)
    return std::nullopt;
  const auto part = [&](unsigned shift) { return static_cast<float>(rgb >> shift & 255u) / 255; };
  return Color{part(16), part(8), part(0), 1};
}
}  // namespace

void MaterialServer::warnUnlessKnown(const std::string& name, const Leaf& user) {
  if (child(name) || warned_.contains(name)) return;
  if (const std::optional<Color> color = colorOf(name)) return define(name, *color);
  if (warned_.size() < 1000) warned_.insert(name);  // bounded, because names may come from a client
  std::vector<std::string> names;
  for (const auto& c : children()) names.push_back(c->name());
  kernel().log().warning("{} uses the material '{}', which {} does not have.{}", user.path(), name, path(),
                         didYouMean(name, names));
}

}  // namespace spark
