#pragma once
/// \file
/// Reads the geoms of an MJCF model.

#include "compiler.h"
#include "height_fields.h"
#include "meshes.h"
#include "robot/geom_mass.h"
#include "robot/model.h"

namespace spark::mjcf {

/// The attribute `condim` of a geom or a pair, 3 where it is not there. Throws Error for one that MuJoCo does not have.
int dimensionsOf(Attributes& a);

/// Reads geoms: their shapes, their masses and their numbers of contacts. Its parts must outlive it.
class GeomReader {
 public:
  GeomReader(const Compiler& compiler, Meshes& meshes, HeightFields& heightFields, Unsupported& unsupported)
      : compiler_(compiler), meshes_(meshes), heightFields_(heightFields), unsupported_(unsupported) {}
  /// Says that an element `pair` names a geom; to be called before the geom is read.
  void addToPairs(const std::string& geom) { inPairs_.insert(geom); }
  /// Reads an element `geom` of `body`; `frame`: of the `frame` elements around. nullopt for a geom that is not
  /// supported, or that is only seen and has a mesh. Throws Error.
  std::optional<Geom> read(Attributes& a, Body& body, const Pose& frame);

 private:
  void contact(Attributes& a, Geom& geom) const;
  /// 0 for a flat mesh without volume. One that is not closed weighs as its hull, which is named.
  engine::Mass meshMass(Attributes& a, const Weight& weight, const Element& geom);
  /// What it adds to the mass of its body; 0, and named, for a flat mesh.
  engine::Mass massOf(Attributes& a, const std::string& type, const Weight& weight, const Geom& geom);
  void place(Attributes& a, const std::string& type, const Pose& frame, Geom& geom);
  void shape(Attributes& a, const std::string& type, const Vec3& size, Geom& geom);

  const Compiler& compiler_;
  Meshes& meshes_;
  HeightFields& heightFields_;
  Unsupported& unsupported_;
  std::set<std::string, std::less<>> inPairs_;
};

}  // namespace spark::mjcf
