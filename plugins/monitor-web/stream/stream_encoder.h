#pragma once
/// \file
/// Encodes the binary frames of the stream: quantised positions and rotations, complete (key frame) or as differences
/// to the previous frame (delta). README.md specifies the format byte by byte.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/math.h"

namespace spark::web {

/// The first byte of a binary message: frames, and what answers requests for the past.
enum class MessageKind : std::uint8_t { key = 1, delta = 2, piece = 3, scene = 4 };

/// Quantisation of a stream: a quantum is 2^-bits, in metres for positions and without unit for quaternions.
struct Precision {
  int position = 0, rotation = 0;  ///< bits, 0..30
  float perMetre() const { return static_cast<float>(1 << position); }
  float perUnit() const { return static_cast<float>(1 << rotation); }
};
inline constexpr Precision kFine{10, 10};  ///< 1 mm, about 0.1 degrees
inline constexpr Precision kCoarse{7, 7};  ///< 8 mm, about 0.9 degrees

/// Where frames place a transform: relative to another one, if a joint links the two. A robot's limb then changes by
/// the turn of its joint only, not with the whole robot.
struct Mount {
  int on = -1;                ///< number of the other transform, which is before it and has the same parent; -1: none
  Vec3f pin = Vec3f::Zero();  ///< the point that the joint holds, in the frame of the transform itself [m]
};

/// Most distance of a pin from its transform [m].
inline constexpr double kMostPin = 1000;

/// Input of the encoder: the scene at one instant. The arrays belong to the caller.
struct Instant {
  std::uint32_t shape = 0;                 ///< number of the scene that it belongs to
  double time = 0;                         ///< s, simulated
  std::span<const Matrix> transforms;      ///< local matrices of the transform nodes, in order
  std::span<const std::uint8_t> visible;   ///< of all nodes, in order
  std::span<const std::uint32_t> toggled;  ///< nodes whose visibility ever changed in this shape; only grows
  /// One for each transform, the same ones in a shape, each on an earlier transform. Another number of them counts as
  /// none, and one that refers to a later transform is ignored.
  std::span<const Mount> mounts;
};

/// A transform in quanta: position x y z and quaternion x y z w. With a mount: the place of the pin in the frame of the
/// other transform, the axis of the rotation from there times 2 tan(angle / 4), and 0.
using Quantised = std::array<std::int32_t, 7>;

/// The matrix of a transform as viewers have it. `other`: that of the transform on which it is; not used without one.
Matrix placeOf(const Quantised& value, const Mount& mount, const Matrix& other, Precision precision);

/// A stream of frames at one precision. A delta is relative to the previous frame; a viewer that missed that one needs
/// a key frame.
class StreamEncoder {
 public:
  explicit StreamEncoder(Precision precision) : precision_(precision) {}

  /// Quantises the next instant. A new shape restarts the stream with a key frame.
  void advance(const Instant& instant);
  /// True if the previous instant has the same shape, so that delta() exists.
  bool hasDelta() const { return hasDelta_; }
  /// The delta to the previous frame; requires hasDelta(). Valid until the next call of delta().
  const std::string& delta();
  /// The key frame, with the visibility of all toggled nodes. Valid until the next call of key().
  const std::string& key();
  /// Number of the current frame; counts from 1 and on across shapes.
  std::uint32_t serial() const { return serial_; }
  /// Shape of the current frame.
  std::uint32_t shape() const { return shape_; }

 private:
  Quantised quantise(const Matrix& m, const Quantised& before) const;
  /// With a mount; writes the matrix that viewers get, too.
  Quantised quantiseOn(const Matrix& other, const Mount& mount, const Matrix& m, const Quantised& before,
                       Matrix& place) const;
  void begin(std::string& out, MessageKind kind) const;
  void writeTransforms(std::string& out, const std::vector<Quantised>& before) const;
  void writeVisibility(std::string& out, const std::vector<std::uint32_t>& nodes) const;

  Precision precision_;
  std::uint32_t shape_ = 0, serial_ = 0;
  double time_ = 0;
  bool hasDelta_ = false;
  std::vector<Quantised> now_, before_, zero_;  ///< current and previous frame; zeros, to which a key frame is relative
  std::vector<Matrix> places_;                  ///< as viewers have them, if there are mounts
  std::vector<std::uint8_t> visible_;
  std::vector<std::uint32_t> toggled_, toggledNow_;  ///< all; those that changed in this frame
  std::string delta_, key_;
};

/// Appends the bytes of a number, little endian.
template <class T>
void putRaw(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
/// Appends an unsigned number in LEB128: seven bits a byte, the lowest first.
void putVarint(std::string& out, std::uint64_t value);
/// Appends a signed number: zigzag, then LEB128.
void putSigned(std::string& out, std::int64_t value);

}  // namespace spark::web
