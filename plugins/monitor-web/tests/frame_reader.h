#pragma once
/// \file
/// Decodes the binary frames like a viewer; written from the description in README.md.

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string_view>

#include "../stream/stream_encoder.h"

namespace spark::web::test {

/// The transforms that a viewer has received. Throws std::runtime_error for a malformed frame.
class FrameReader {
 public:
  explicit FrameReader(std::size_t transforms) : quantised(transforms), mounts(transforms) {}

  void take(std::string_view frame) {
    bytes_ = frame;
    const auto kind = raw<std::uint8_t>();
    positionBits = raw<std::uint8_t>();
    rotationBits = raw<std::uint8_t>();
    must(raw<std::uint8_t>() == 0, "a zero");
    shape = raw<std::uint32_t>();
    const auto number = raw<std::uint32_t>();
    must(kind == 1 || (kind == 2 && number == serial + 1), "a key, or the delta to the last frame");
    serial = number;
    time = raw<double>();
    if (kind == 1) {
      visible.clear();
      for (auto& q : quantised) q = {};
    }
    readTransforms();
    for (auto n = varint(); n > 0; --n) {
      const auto node = varint();
      visible[node] = raw<std::uint8_t>() != 0;
    }
    must(bytes_.empty(), "the end");
  }

  /// Where transform `i` is.
  Pose poseOf(std::size_t i) const {
    const auto& q = quantised[i];
    const Mount& mount = mounts[i];
    const double perMetre = std::ldexp(1, positionBits), perUnit = std::ldexp(1, rotationBits);
    const Vec3 place = Vec3(double(q[0]), double(q[1]), double(q[2])) / perMetre;
    const Vec3 turn = Vec3(double(q[3]), double(q[4]), double(q[5])) / perUnit;
    if (mount.on < 0) {
      const Eigen::Quaterniond rotation(double(q[6]) / perUnit, turn.x(), turn.y(), turn.z());
      return {place, rotation.normalized().toRotationMatrix()};
    }
    const Pose other = poseOf(static_cast<std::size_t>(mount.on));
    const double angle = 4 * std::atan(turn.norm() / 2);
    const Vec3 axis = turn.norm() > 0 ? turn.normalized() : Vec3::UnitX();
    Pose out;
    out.rotation = other.rotation * Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    out.position = other.position + other.rotation * place - out.rotation * mount.pin.cast<double>();
    return out;
  }
  /// True if transform `i` equals the matrix to within `quanta` quanta.
  bool isNear(std::size_t i, const Matrix& m, double quanta = 1) const {
    const Pose pose = poseOf(i);
    for (int row = 0; row < 3; ++row) {
      if (!(std::abs(pose.position[row] - m(row, 3)) <= quanta * std::ldexp(1, -positionBits))) return false;
      for (int column = 0; column < 3; ++column)
        if (!(std::abs(pose.rotation(row, column) - m(row, column)) <= 4 * quanta * std::ldexp(1, -rotationBits)))
          return false;
    }
    return true;
  }

  std::vector<std::array<std::int64_t, 7>> quantised;
  std::vector<Mount> mounts;              ///< as the scene has them
  std::map<std::uint64_t, bool> visible;  ///< by node, from the last key frame and the deltas since
  std::uint32_t shape = 0, serial = 0;
  int positionBits = 0, rotationBits = 0;
  double time = 0;

 private:
  static void must(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string("expected ") + what);
  }
  template <class T>
  T raw() {
    must(bytes_.size() >= sizeof(T), "more bytes");
    T value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = raw<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7fu} << shift;
      if (byte < 0x80) return value;
    }
  }
  std::int64_t zigzag() {
    const auto v = varint();
    return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
  }
  void readTransforms() {
    for (std::size_t at = 0;;) {
      at += varint();
      auto count = varint();
      if (count == 0) return;
      for (; count > 0; --count, ++at) {
        must(at < quantised.size(), "a transform of the scene");
        const auto mask = raw<std::uint8_t>();
        for (int k = 0; k < 7; ++k)
          if (mask >> k & 1) quantised[at][k] += zigzag();
      }
    }
  }
  std::string_view bytes_;
};

}  // namespace spark::web::test
