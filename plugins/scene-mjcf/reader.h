#pragma once
/// \file
/// Reads the elements of an MJCF model.

#include "actuator_reader.h"
#include "compiler.h"
#include "constraint_reader.h"
#include "geom_reader.h"
#include "height_fields.h"
#include "meshes.h"
#include "robot/model.h"

namespace spark::mjcf {

/// One run over a document.
class Reader {
 public:
  Reader(Document& document, const ReadMesh& readMesh, const ReadHeights& readHeights, Unsupported& unsupported)
      : document_(document), unsupported_(unsupported), meshes_(readMesh), heightFields_(readHeights) {}
  Model read();

 private:
  /// What elements in a body inherit.
  struct Scope {
    int body = 0;
    std::string childClass;
    Pose frame;  ///< of `frame` elements around; with global coordinates the world's, as seen from the body
    int depth = 0;
  };
  /// Counts an element. Throws Error when there are too many.
  void count(const Element& e);
  /// The attributes of an element, which is counted.
  Attributes attributes(const Element& e, const std::string& childClass = "");
  void section(const Element& e);
  /// Which geoms may collide, as the option `collision` says.
  void chooseCollisions();
  void option(const Element& e);
  void asset(const Element& e);
  void content(const Element& parent, const Scope& scope);
  void body(const Element& e, const Scope& scope);
  void frame(const Element& e, Scope scope);
  void inertial(const Element& e, const Scope& scope);
  void placeOpenFrames();
  void joint(const Element& e, const Scope& scope);
  Joint freeJoint(const Element& e);
  Joint typedJoint(const Element& e, const Scope& scope);
  void readSpringDamper(Attributes& a, Joint& j);
  void geom(const Element& e, const Scope& scope);
  void site(const Element& e, const Scope& scope);
  void finishMasses();
  void scaleMasses();
  void notePairs(const Element& e);
  void contact(const Element& e);
  void constraint(const Element& e, bool tendon);
  void actuator(const Element& e);
  void sensor(const Element& e);

  Document& document_;
  Unsupported& unsupported_;
  Model model_;
  Compiler compiler_;
  Defaults defaults_;
  Meshes meshes_;
  HeightFields heightFields_;
  GeomReader geoms_{compiler_, meshes_, heightFields_, unsupported_};
  ActuatorReader actuators_{compiler_, defaults_, unsupported_};
  ConstraintReader constraints_{compiler_, defaults_, unsupported_};
  std::vector<Pose> globalPoses_;  ///< of bodies, with global coordinates
  std::size_t elements_ = 0;
};

}  // namespace spark::mjcf
