#include "compiler.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "robot/mended_numbers.h"

namespace spark::mjcf {

namespace {

Mat3 turnTo(const Vec3& z) { return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), z).toRotationMatrix(); }

/// The same direction with a length whose square is a number; others keep their digits.
Vec3 shortened(const Vec3& v) { return std::isfinite(v.squaredNorm()) ? v : v.stableNormalized(); }

/// True for a vector that has a direction.
bool isLong(const Vec3& v) { return v.stableNorm() > 1e-10; }

/// An attribute that cannot be used is an error, or no rotation, which is named.
Mat3 refuse(Attributes& a, const char* name, const std::string& expected) {
  const std::string text = fmt::format("expected {} for '{}'", expected, name);
  if (!a.isForgiving()) throw a.element().error(text);
  a.note(fmt::format("'{}' of <{}> is ignored: {}", name, a.element().tag(), text));
  return Mat3::Identity();
}

}  // namespace

void Compiler::read(Attributes& a) {
  a.forgive();
  degrees_ = a.word("angle", {"degree", "radian"}, degrees_ ? "degree" : "radian") == "degree";
  autolimits_ = a.flag("autolimits", autolimits_);
  eulerSequence_ = a.text("eulerseq", eulerSequence_.c_str());
  if (eulerSequence_.size() != 3)
    throw a.element().error(fmt::format("expected three of x y z X Y Z for 'eulerseq', found '{}'", eulerSequence_));
  std::string folder = a.text("meshdir", a.text("assetdir", meshFolder_.c_str()).c_str());
  if (!folder.empty() && folder.back() != '/') folder += '/';
  while (folder.starts_with("./")) folder.erase(0, 2);
  meshFolder_ = folder;
  inertiaFromGeom_ = a.word("inertiafromgeom", {"auto", "true", "false"}, inertiaFromGeom_.c_str());
  if (std::array<double, 2> groups{}; a.take("inertiagrouprange", groups))
    for (std::size_t i = 0; i < 2; ++i) inertiaGroups_[i] = static_cast<int>(std::clamp(groups[i], -1e9, 1e9));
  fitsBounds_ = a.flag("fitaabb", fitsBounds_);
  stripsPaths_ = a.flag("strippath", stripsPaths_);
  exactMeshInertia_ = a.flag("exactmeshinertia", exactMeshInertia_);
  boundMass_ = a.number("boundmass", boundMass_);
  boundInertia_ = a.number("boundinertia", boundInertia_);
  balances_ = a.flag("balanceinertia", balances_);
  totalMass_ = a.number("settotalmass", totalMass_);
  global_ = a.word("coordinate", {"local", "global"}, global_ ? "global" : "local") == "global";
  // Bodies without joints become part of their parents in any case.
  a.ignore({"texturedir", "discardvisual", "fusestatic", "convexhull", "usethread", "alignfree"});
  a.finish();
}

std::string Compiler::fileName(const std::string& name) const {
  const std::size_t slash = name.find_last_of("/\\");
  return stripsPaths_ && slash != std::string::npos ? name.substr(slash + 1) : name;
}

void Compiler::adjust(engine::Mass& mass) const {
  if (mass.mass <= 0 && boundMass_ <= 0) return;
  mass.mass = std::max(mass.mass, boundMass_);
  if (boundInertia_ <= 0 && !balances_) return;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(mass.inertia);
  const Vec3 moments = axes.eigenvalues().cwiseMax(boundInertia_);  // ascending
  if (balances_ && moments[0] + moments[1] < moments[2])
    mass.inertia = Vec3::Constant(moments.mean()).asDiagonal();
  else if (boundInertia_ > 0)
    mass.inertia = axes.eigenvectors() * moments.asDiagonal() * axes.eigenvectors().transpose();
}

std::optional<Mat3> Compiler::orientation(Attributes& a) const {
  std::array<double, 4> four{};
  if (a.take("quat", four)) {
    Eigen::Quaterniond q(four[0], four[1], four[2], four[3]);
    if (!std::isfinite(q.squaredNorm())) q.coeffs() /= q.coeffs().cwiseAbs().maxCoeff();
    if (q.norm() > 1e-10) return q.normalized().toRotationMatrix();
    a.note(fmt::format("a 'quat' of 0 in <{}> is taken as no rotation", a.element().tag()));
    return Mat3::Identity();
  }
  if (a.take("axisangle", four)) {
    const Vec3 axis(four[0], four[1], four[2]);
    if (!isLong(axis)) return refuse(a, "axisangle", "an axis that is not 0");
    return Eigen::AngleAxisd(angle(four[3]), shortened(axis).normalized()).toRotationMatrix();
  }
  std::array<double, 6> six{};
  if (a.take("xyaxes", six)) {
    const Vec3 first = shortened({six[0], six[1], six[2]}), along = shortened({six[3], six[4], six[5]});
    const Vec3 x = first.normalized(), y = along - x * x.dot(along);
    if (!isLong(first) || !(y.norm() > 1e-10 * along.norm())) return refuse(a, "xyaxes", "two different directions");
    Mat3 r;
    r << x, y.normalized(), x.cross(y.normalized());
    return r;
  }
  if (Vec3 z; a.take("zaxis", z)) {
    return isLong(z) ? turnTo(shortened(z)) : refuse(a, "zaxis", "a direction that is not 0");
  }
  if (Vec3 angles; a.take("euler", angles)) {
    if (eulerSequence_.find_first_not_of("xyzXYZ") != std::string::npos)
      throw a.element().error(
          fmt::format("expected an 'eulerseq' of x y z X Y Z in <compiler>, found '{}'", eulerSequence_));
    Mat3 r = Mat3::Identity();
    for (int i = 0; i < 3; ++i) {
      const char letter = eulerSequence_[static_cast<std::size_t>(i)];
      const bool fixedFrame = letter < 'a';
      const Mat3 turn = Eigen::AngleAxisd(angle(angles[i]), Vec3(Vec3::Unit((letter | 32) - 'x'))).toRotationMatrix();
      r = fixedFrame ? Mat3(turn * r) : Mat3(r * turn);
    }
    return r;
  }
  return std::nullopt;
}

Pose Compiler::pose(Attributes& a, const Pose& frame) const {
  Pose p;
  a.take("pos", p.position);
  if (!(p.position.cwiseAbs().maxCoeff() <= kPlaces.most)) {
    const std::string expected = fmt::format("expected a place at most {:g} m away", kPlaces.most);
    if (!a.isForgiving()) throw a.element().error(expected);
    a.note(fmt::format("'pos' of <{}> is ignored: {}", a.element().tag(), expected));
    p.position.setZero();
  }
  if (const auto r = orientation(a)) p.rotation = *r;
  return compose(frame, p);
}

std::optional<Compiler::Span> Compiler::fromTo(Attributes& a, const Pose& frame) const {
  std::array<double, 6> ends{};
  if (!a.take("fromto", ends)) return std::nullopt;
  const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
  if (!(from.cwiseAbs().maxCoeff() <= kPlaces.most && to.cwiseAbs().maxCoeff() <= kPlaces.most))
    throw a.element().error(fmt::format("expected places at most {:g} m away for 'fromto'", kPlaces.most));
  const double length = (to - from).norm();
  if (!(length > 1e-10)) throw a.element().error("expected two different points in 'fromto'");
  return Span{compose(frame, {(from + to) / 2, turnTo(from - to)}), length};
}

void Limit::read(Attributes& a, const char* flag, const char* name) {
  word = a.word(flag, {"true", "false", "auto"}, word.c_str());
  if (auto found = a.numbers(name, 2, 2)) range = std::move(found);
}

std::optional<std::array<double, 2>> Compiler::limit(Attributes& a, const char* name, const Limit& l) const {
  const std::array<double, 2> range = l.range ? std::array{(*l.range)[0], (*l.range)[1]} : std::array{0.0, 0.0};
  const bool on = l.word == "auto" ? autolimits_ && (range[0] != 0 || range[1] != 0) : l.word == "true";
  if (!on) return std::nullopt;
  if (range[0] < range[1]) return range;
  const std::string expected =
      fmt::format("expected a lower and a higher number for '{}' of <{}>, which is limited", name, a.element().tag());
  if (!a.isForgiving()) throw a.element().error(expected);
  a.note(fmt::format("'{}' of <{}> is ignored: {}, found {:g} {:g}", name, a.element().tag(), expected, range[0],
                     range[1]));
  return std::nullopt;
}

}  // namespace spark::mjcf
