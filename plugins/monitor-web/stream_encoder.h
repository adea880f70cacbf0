#pragma once
/// \file
/// The binary frames that viewers get: quantised positions and rotations, whole (key) or as differences to the frame
/// before (delta). Pure computation; README.md has the format byte by byte.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "api/math.h"

namespace spark::web {

/// How finely a stream is quantised: a step is 2^-bits (metres; parts of a unit quaternion).
struct Precision {
  int position = 0, rotation = 0;
};
inline constexpr Precision kFine{10, 10};  ///< 1 mm, some 0.1 degrees
inline constexpr Precision kCoarse{7, 7};  ///< 8 mm, some 0.9 degrees

/// One instant as a stream takes it.
struct Instant {
  std::uint32_t shape = 0;                  ///< number of the scene that it belongs to
  double time = 0;                          ///< s
  std::span<const Matrix> transforms;       ///< local, of the transform nodes in order
  std::span<const std::uint8_t> visible;    ///< of all nodes
  std::span<const std::uint32_t> flickers;  ///< nodes whose visibility ever changed in this shape
};

/// One stream of frames at one precision. Deltas build on the frame before: who missed one needs a key.
class StreamEncoder {
 public:
  explicit StreamEncoder(Precision precision) : precision_(precision) {}

  /// Takes the next instant. With another shape everything begins anew.
  void advance(const Instant& instant);
  /// True when there is an instant before of the same shape, to which delta() is.
  bool hasDelta() const { return hasDelta_; }
  /// The frame as difference to the one before. Valid until the next call of it.
  const std::string& delta();
  /// The whole frame, with the visibility of all that flicker. Valid until the next call of it.
  const std::string& key();
  /// Of the instant taken last; counts from 1.
  std::uint32_t serial() const { return serial_; }
  std::uint32_t shape() const { return shape_; }

 private:
  /// Position x y z, quaternion x y z w, in steps.
  using Quantised = std::array<std::int32_t, 7>;
  Quantised quantise(const Matrix& m, const Quantised& before) const;
  void begin(std::string& out, std::uint8_t kind) const;
  void writeTransforms(std::string& out, const std::vector<Quantised>& before) const;
  void writeVisibility(std::string& out, const std::vector<std::uint32_t>& nodes) const;

  Precision precision_;
  std::uint32_t shape_ = 0, serial_ = 0;
  double time_ = 0;
  bool hasDelta_ = false;
  std::vector<Quantised> now_, before_, zero_;
  std::vector<std::uint8_t> visible_;
  std::vector<std::uint32_t> flickers_, flickered_;  ///< all; those that changed with this instant
  std::string delta_, key_;
};

/// Appends an unsigned number in LEB128: seven bits a byte, the lowest first.
void putVarint(std::string& out, std::uint64_t value);
/// Appends a signed number: zigzag, then LEB128.
void putSigned(std::string& out, std::int64_t value);

}  // namespace spark::web
