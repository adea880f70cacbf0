#pragma once
/// \file
/// Reads the elements of an MJCF model.

#include <map>

#include "model.h"

namespace spark::mjcf {

/// What the element `compiler` says.
struct Compiler {
  bool degrees = true;     ///< angles of the file
  bool autolimits = true;  ///< a range alone makes a limit
  std::string eulerSequence = "xyz";
  std::string meshFolder;  ///< "" or "a/"
  std::string inertiaFromGeom = "auto";
  std::array<int, 2> inertiaGroups{0, 5};
  double boundMass = 0, boundInertia = 0;
};

/// A mesh of the element `asset`.
struct MeshAsset {
  Element from;
  std::string file;
  Vec3 scale{1, 1, 1};
  std::optional<engine::ShapeDescription> loaded;
};

/// One run over a document.
class Reader {
 public:
  Reader(Document& document, const ReadMesh& readMesh, LeftOver& leftOver)
      : document_(document), readMesh_(readMesh), leftOver_(leftOver) {}
  Model read();

 private:
  /// What elements in a body inherit.
  struct Scope {
    int body = 0;
    std::string childClass;
    Pose frame;  ///< of `frame` elements around
    int depth = 0;
  };
  Attributes attributes(const Element& e, const std::string& childClass = "");
  void compiler(const Element& e);
  void option(const Element& e);
  void asset(const Element& e);
  void mesh(const Element& e);
  void content(const Element& parent, const Scope& scope);
  void body(const Element& e, const Scope& scope);
  void frame(const Element& e, Scope scope);
  void inertial(const Element& e, Body& body);
  void joint(const Element& e, const Scope& scope);
  void geom(const Element& e, const Scope& scope);
  void site(const Element& e, const Scope& scope);
  void contact(const Element& e);
  void actuator(const Element& e);
  void sensor(const Element& e);
  Pose pose(Attributes& a, const Scope& scope);
  /// Both ends of a capsule or cylinder.
  bool fromTo(Attributes& a, const Scope& scope, Pose& pose, double& length);
  std::optional<Mat3> orientation(Attributes& a);
  double angle(double v) const { return compiler_.degrees ? degToRad(v) : v; }
  bool limited(Attributes& a, const char* flag, const char* what, const std::optional<std::vector<double>>& range);
  engine::ShapeDescription shape(Attributes& a, const Scope& scope, Pose& pose);
  engine::ShapeDescription meshShape(Attributes& a);
  void massOf(Attributes& a, Geom& geom, const std::optional<Vec3>& ellipsoid);
  void apply(const Element& e, Actuator& x, std::string& meaning);
  void finishMasses();

  Document& document_;
  const ReadMesh& readMesh_;
  LeftOver& leftOver_;
  Model model_;
  Compiler compiler_;
  Defaults defaults_;
  std::map<std::string, MeshAsset, std::less<>> meshes_;
  std::size_t elements_ = 0, meshNumbers_ = 0;
};

}  // namespace spark::mjcf
