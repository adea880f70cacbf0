#include "visuals.h"

#include "materials.h"
#include "scene_server.h"

namespace spark {

namespace {
/// nullptr while `leaf` is not linked, or when there is none.
SceneServer* serverOf(const Leaf& leaf) {
  return leaf.isLinked() ? leaf.find<SceneServer>(ISceneServer::kPath) : nullptr;
}
}  // namespace

void Light::describe(Description<Light>& d) {
  d.doc("A light source, for viewers.");
  d.implements<IVisual>();
  d.property("diffuse", &Light::color<&Light::diffuse_>, &Light::setColor<&Light::diffuse_>).doc("Diffuse colour.");
  d.property("ambient", &Light::color<&Light::ambient_>, &Light::setColor<&Light::ambient_>).doc("Ambient colour.");
  d.property("specular", &Light::color<&Light::specular_>, &Light::setColor<&Light::specular_>).doc("Specular colour.");
  d.property("radius", &Light::radius_).unit("m").min(0).doc("Range of the light.");
}

void Camera::describe(Description<Camera>& d) {
  d.doc("A view of the scene, for viewers.");
  d.method("setViewport", &Camera::setViewport)
      .parameters({"x [px]", "y [px]", "width [px]", "height [px]"})
      .doc("Sets the part of the window that the view fills.");
  d.property("viewportX", &Camera::x_).unit("px").doc("Left edge.");
  d.property("viewportY", &Camera::y_).unit("px").doc("Lower edge.");
  d.property("viewportWidth", &Camera::width_).unit("px").min(0).doc("Width.");
  d.property("viewportHeight", &Camera::height_).unit("px").min(0).doc("Height.");
  d.property("FOV", &Camera::fovDeg_).unit("deg").range(0, 180).doc("Horizontal opening angle.");
  d.property("zNear", &Camera::zNear_).unit("m").doc("Distance of the near clipping plane.");
  d.property("zFar", &Camera::zFar_).unit("m").doc("Distance of the far clipping plane.");
  d.method("adjustZNear", &Camera::adjustZNear).parameters({"by [m]"}).doc("Adds to zNear.");
  d.method("adjustZFar", &Camera::adjustZFar).parameters({"by [m]"}).doc("Adds to zFar.");
  d.property("target", &Camera::lookAt_).unit("m").doc("The point it looks at, world frame.");
  d.alias("lookAt", "setTarget");
}

void Axis::describe(Description<Axis>& d) {
  d.doc("A visible coordinate frame at its transform, for viewers.");
  d.property("size", &Axis::size_).unit("m").min(0).doc("Length of the arms.");
}

void RenderNode::describe(Description<RenderNode>& d) {
  d.doc("Base of all visible shapes.");
  d.property("visible", &RenderNode::visible_).state().doc("Viewers show it.");
  d.method("setVisible", &RenderNode::setVisibleValue)
      .parameters({"on"})
      .doc("1 shows, 0 hides. A text is converted to a number, so that 'true' hides, as in the installed base.");
  d.property("transparent", &RenderNode::isTransparent).doc("Drawn with the opacity of its material.");
  d.method("setTransparent", &RenderNode::setTransparent).doc("Makes it transparent. This cannot be undone.");
  d.abstract();
}

void RenderNode::setVisibleValue(Value v) {
  if (v.isBool()) return show(v.toBool());
  Args args{std::span(&v, 1), true};
  show(Convert<int>::from(args) != 0);
}

void StaticMesh::describe(Description<StaticMesh>& d) {
  d.doc("A mesh by name, for viewers; the simulation never loads it.");
  d.implements<IVisual>();
  d.implements<ISceneCalls>();
  d.property("mesh", &StaticMesh::load_).readOnly().doc("Name and parameters of the mesh.");
  d.method("load", &StaticMesh::loadCall)
      .parameters({"mesh", "parameters"})
      .doc("Sets the mesh: 'models/x.obj', or a standard mesh with parameters.");
  d.property("scale", &StaticMesh::scale_).unit("1").readOnly().doc("Scale of the mesh.");
  d.method("setScale", &StaticMesh::setScale).parameters({"scale"}).doc("Sets the scale of the mesh.");
  d.property("materials", &StaticMesh::materials_)
      .readOnly()
      .doc("Material of each face group, in alphabetical order of the mesh's own names.");
  d.method("resetMaterials", &StaticMesh::resetMaterials).parameters({"materials"}).doc("Replaces all materials.");
  d.property("castShadows", &StaticMesh::castShadows_).doc("Viewers let it cast shadows.");
  d.property("useExternalMesh", &StaticMesh::useExternalMesh_).doc("Viewers show the external mesh instead.");
  d.property("externalMeshName", &StaticMesh::externalMesh_).doc("The external mesh.");
  d.property("externalMeshScale", &StaticMesh::externalScale_).unit("1").doc("Its scale.");
}

std::vector<SceneCall> StaticMesh::sceneCalls() const {
  std::vector<SceneCall> calls;
  // Boxes and spheres have their meshes from the start.
  if (!load_.empty() && !load_.starts_with("StdUnit")) calls.push_back({"load", {load_}});
  for (SceneCall& call : callsBesideMesh()) calls.push_back(std::move(call));
  return calls;
}

std::vector<SceneCall> StaticMesh::callsBesideMesh() const {
  std::vector<SceneCall> calls;
  if (scale_ != Vec3f(1, 1, 1))
    calls.push_back({"setScale", {shortest(scale_.x()), shortest(scale_.y()), shortest(scale_.z())}});
  if (!materials_.empty()) calls.push_back({"resetMaterials", List(materials_.begin(), materials_.end())});
  if (isTransparent()) calls.push_back({"setTransparent", {}});
  return calls;
}

void StaticMesh::loadCall(std::string mesh, const std::vector<Value>& parameters) {
  for (const Value& p : parameters) mesh += " " + p.plain();
  loadMesh(std::move(mesh));
}

void StaticMesh::loadMesh(std::string load) {
  load_ = std::move(load);
  if (!classObject()) return;
  meshChanged();
  markModified(*this);
}

void StaticMesh::meshChanged() {
  if (SceneServer* server = serverOf(*this)) materials_ = server->meshes().materials(kernel(), load_);
}

void StaticMesh::setScale(const Vec3f& scale) {
  scale_ = scale;
  if (classObject()) markModified(*this);
}

void StaticMesh::resetMaterials(std::vector<std::string> names) {
  if (isLinked())
    if (auto* known = kernel().root().find<MaterialServer>("/sys/server/material"))
      for (const std::string& name : names) known->warnUnlessKnown(name, *this);
  materials_ = std::move(names);
  markModified(*this);
}

void StaticMesh::saveState(StateWriter& out) const { out.write(materials_); }

void StaticMesh::loadState(StateReader& in) {
  const Value names = in.readValue();
  Args args{std::span(&names, 1)};
  materials_ = Convert<std::vector<std::string>>::from(args);
}

void StaticMesh::setMaterialName(std::size_t i, std::string name) {
  if (i >= materials_.size() || materials_[i] == name) return;
  materials_[i] = std::move(name);
  markModified(*this);
}

void SingleMatNode::describe(Description<SingleMatNode>& d) {
  d.doc("A mesh with one material.");
  d.method("setMaterial", &SingleMatNode::setMaterial).parameters({"material"}).doc("Sets the material, by name.");
}

void Box::describe(Description<Box>& d) {
  d.doc("A visible box.");
  d.method("setExtents", &Box::setScale).parameters({"edges [m]"}).doc("Sets the full edge lengths.");
}

void Sphere::describe(Description<Sphere>& d) {
  d.doc("A visible sphere.");
  d.property("radius", &Sphere::radius, &Sphere::setRadius).unit("m").min(0).doc("Radius.");
}

void Capsule::describe(Description<Capsule>& d) {
  d.doc("A visible capsule along z.");
  d.method("setParams", &Capsule::setParams)
      .parameters({"radius [m]", "length [m]"})
      .doc("Sets the radius, and the length without the caps.");
  d.property("radius", &Capsule::radius_).unit("m").readOnly().doc("Radius.");
  d.property("length", &Capsule::length_).unit("m").readOnly().doc("Length without the caps.");
}

std::vector<SceneCall> Capsule::sceneCalls() const {
  std::vector<SceneCall> calls{{"setParams", {shortest(radius_), shortest(length_)}}};
  for (SceneCall& call : callsBesideMesh()) calls.push_back(std::move(call));
  return calls;
}

void Capsule::setParams(float radius, float length) {
  radius_ = radius, length_ = length;
  loadMesh(fmt::format("StdCapsule {:g} {:g}", radius, length));
}

void Cylinder::describe(Description<Cylinder>& d) {
  d.doc("A visible cylinder along z.");
  d.method("setParams", &Cylinder::setParams)
      .parameters({"radius [m]", "length [m]"})
      .doc("Sets radius and length. Viewers draw a unit cylinder, so set the scale as well.");
  d.property("radius", &Cylinder::radius_).unit("m").readOnly().doc("Radius.");
  d.property("length", &Cylinder::length_).unit("m").readOnly().doc("Length.");
}

std::vector<SceneCall> Cylinder::sceneCalls() const {
  std::vector<SceneCall> calls{{"setParams", {shortest(radius_), shortest(length_)}}};
  for (SceneCall& call : callsBesideMesh()) calls.push_back(std::move(call));
  return calls;
}

void Cylinder::setParams(float radius, float length) {
  radius_ = radius, length_ = length;
  loadMesh(fmt::format("StdUnitCylinder {:g} {:g}", radius, length));
}

}  // namespace spark
