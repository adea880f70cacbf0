#include "stream_encoder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>

namespace spark::web {

static_assert(std::endian::native == std::endian::little, "frames are little endian");

namespace {
// Unchanged transforms within a run cost a byte each, a new run two or more: shorter gaps do not end a run.
constexpr std::size_t kMinGap = 3;

// Hysteresis in quanta: a value changes only if it is this far from the current one, so noise around the midpoint of
// two quanta sends nothing.
constexpr float kHysteresis = 1.f;

constexpr float kMaxQuantised = 1 << 30;

/// Rounds with hysteresis. Keeps the previous value if `exact` is not finite.
std::int32_t quantum(float exact, std::int32_t before) {
  if (!std::isfinite(exact)) return before;
  if (std::abs(exact - static_cast<float>(before)) <= kHysteresis) return before;
  // As std::lround(), which is a call.
  const double value = std::clamp(exact, -kMaxQuantised, kMaxQuantised);
  return static_cast<std::int32_t>(value + (value < 0 ? -0.5 : 0.5));
}

/// The rotation of a matrix. Tolerates scaled and sheared matrices; the identity if there is none.
Eigen::Quaternionf rotationOf(const Matrix& m) {
  const Eigen::Matrix3f r = m.block<3, 3>(0, 0);
  const Eigen::Quaternionf q = Eigen::Quaternionf(r).normalized();
  return q.coeffs().allFinite() && q.squaredNorm() > 0.5f ? q : Eigen::Quaternionf::Identity();
}

Vec3f firstThree(const Quantised& value) {
  return {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
}

Matrix matrixOf(const Eigen::Matrix3f& rotation, const Vec3f& position) {
  Matrix out = Matrix::Identity();
  out.block<3, 3>(0, 0) = rotation;
  out.block<3, 1>(0, 3) = position;
  return out;
}

/// The rotation of a transform on another one.
Eigen::Matrix3f rotationOn(const Matrix& other, const Quantised& value, Precision precision) {
  const Vec3f turn(static_cast<float>(value[3]), static_cast<float>(value[4]), static_cast<float>(value[5]));
  const Vec3f half = turn * (0.5f / precision.perUnit());  // tan(angle / 4)
  const float s = half.squaredNorm();
  Eigen::Quaternionf q;
  q.w() = (1 - s) / (1 + s);
  q.vec() = half * (2 / (1 + s));
  return other.block<3, 3>(0, 0) * q.toRotationMatrix();
}

/// Its position, with that rotation.
Vec3f positionOn(const Matrix& other, const Quantised& value, const Mount& mount, const Eigen::Matrix3f& rotation,
                 Precision precision) {
  const Vec3f pin = firstThree(value) * (1 / precision.perMetre());
  return positionOf(other) + other.block<3, 3>(0, 0) * pin - rotation * mount.pin;
}
}  // namespace

void putVarint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<char>(value | 0x80));
  out.push_back(static_cast<char>(value));
}

void putSigned(std::string& out, std::int64_t value) {
  putVarint(out, static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
}

Matrix placeOf(const Quantised& value, const Mount& mount, const Matrix& other, Precision precision) {
  if (mount.on >= 0) {
    const Eigen::Matrix3f rotation = rotationOn(other, value, precision);
    return matrixOf(rotation, positionOn(other, value, mount, rotation, precision));
  }
  const Eigen::Quaternionf q(static_cast<float>(value[6]), static_cast<float>(value[3]), static_cast<float>(value[4]),
                             static_cast<float>(value[5]));
  const bool turned = q.squaredNorm() > 0;
  return matrixOf(turned ? q.normalized().toRotationMatrix() : Eigen::Matrix3f(Eigen::Matrix3f::Identity()),
                  firstThree(value) * (1 / precision.perMetre()));
}

Quantised StreamEncoder::quantise(const Matrix& m, const Quantised& before) const {
  const float perMetre = precision_.perMetre(), perUnit = precision_.perUnit();
  Quantised out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = quantum(positionOf(m)[k] * perMetre, before[k]);
  const Eigen::Vector4f q = rotationOf(m).coeffs();
  const Eigen::Vector4f last(static_cast<float>(before[3]), static_cast<float>(before[4]),
                             static_cast<float>(before[5]), static_cast<float>(before[6]));
  const float sign = q.dot(last) < 0 ? -1.f : 1.f;  // q and -q are the same rotation: take the nearer one
  for (std::size_t k = 0; k < 4; ++k) out[3 + k] = quantum(sign * q[k] * perUnit, before[3 + k]);
  return out;
}

/// Relative to where viewers have the other one, so that errors do not add up.
Quantised StreamEncoder::quantiseOn(const Matrix& other, const Mount& mount, const Matrix& m, const Quantised& before,
                                    Matrix& place) const {
  const float perMetre = precision_.perMetre(), perUnit = precision_.perUnit();
  const Eigen::Matrix3f back = other.block<3, 3>(0, 0).transpose();
  Quantised out{};
  const Eigen::Quaternionf q(Eigen::Matrix3f(back * rotationOf(m).toRotationMatrix()));
  const Vec3f turn = q.vec() * ((q.w() < 0 ? -2 : 2) * perUnit / (1 + std::abs(q.w())));
  for (std::size_t k = 0; k < 3; ++k) out[3 + k] = quantum(turn[k], before[3 + k]);
  const Eigen::Matrix3f rotation = rotationOn(other, out, precision_);
  const Vec3f pin = back * (positionOf(m) - (positionOf(other) - rotation * mount.pin));
  for (std::size_t k = 0; k < 3; ++k) out[k] = quantum(pin[k] * perMetre, before[k]);
  place = matrixOf(rotation, positionOn(other, out, mount, rotation, precision_));
  return out;
}

void StreamEncoder::advance(const Instant& instant) {
  const std::size_t size = instant.transforms.size();
  hasDelta_ =
      serial_ > 0 && instant.shape == shape_ && size == now_.size() && instant.visible.size() == visible_.size();
  if (!hasDelta_) {
    zero_.assign(size, {});
    now_ = zero_;
  }
  std::swap(before_, now_);
  now_.resize(size);
  places_.resize(instant.mounts.size() == size ? size : 0);
  for (std::size_t i = 0; i < size; ++i) {
    const Mount mount = places_.empty() || instant.mounts[i].on >= static_cast<int>(i) ? Mount{} : instant.mounts[i];
    if (mount.on >= 0) {
      const Matrix& other = places_[static_cast<std::size_t>(mount.on)];
      now_[i] = quantiseOn(other, mount, instant.transforms[i], before_[i], places_[i]);
    } else {
      now_[i] = quantise(instant.transforms[i], before_[i]);
      if (!places_.empty()) places_[i] = placeOf(now_[i], mount, Matrix::Identity(), precision_);
    }
  }
  toggled_.assign(instant.toggled.begin(), instant.toggled.end());
  toggledNow_.clear();
  for (const std::uint32_t node : toggled_)
    if (hasDelta_ && visible_[node] != instant.visible[node]) toggledNow_.push_back(node);
  visible_.assign(instant.visible.begin(), instant.visible.end());
  shape_ = instant.shape;
  time_ = instant.time;
  ++serial_;
}

void StreamEncoder::begin(std::string& out, MessageKind kind) const {
  out.clear();
  putRaw(out, kind);
  putRaw(out, static_cast<std::uint8_t>(precision_.position));
  putRaw(out, static_cast<std::uint8_t>(precision_.rotation));
  putRaw(out, std::uint8_t{0});
  putRaw(out, shape_);
  putRaw(out, serial_);
  putRaw(out, time_);
}

void StreamEncoder::writeTransforms(std::string& out, const std::vector<Quantised>& before) const {
  const std::size_t size = now_.size();
  const auto same = [&](std::size_t i) { return now_[i] == before[i]; };
  for (std::size_t at = 0, begin = 0;; at = begin) {
    // Find the next run of changed transforms, [begin, end); it may contain gaps shorter than kMinGap.
    while (begin < size && same(begin)) ++begin;
    if (begin == size) break;
    std::size_t end = begin + 1;
    for (std::size_t i = end; i < size && i < end + kMinGap; ++i)
      if (!same(i)) end = i + 1;
    // Write the run.
    putVarint(out, begin - at);
    putVarint(out, end - begin);
    for (; begin < end; ++begin) {
      std::uint8_t mask = 0;
      for (int k = 0; k < 7; ++k) mask |= static_cast<std::uint8_t>((now_[begin][k] != before[begin][k]) << k);
      putRaw(out, mask);
      for (int k = 0; k < 7; ++k)
        if (mask >> k & 1) putSigned(out, std::int64_t{now_[begin][k]} - before[begin][k]);
    }
  }
  // An empty run ends the list.
  putVarint(out, 0);
  putVarint(out, 0);
}

void StreamEncoder::writeVisibility(std::string& out, const std::vector<std::uint32_t>& nodes) const {
  putVarint(out, nodes.size());
  for (const std::uint32_t node : nodes) {
    putVarint(out, node);
    putRaw(out, visible_[node]);
  }
}

const std::string& StreamEncoder::delta() {
  begin(delta_, MessageKind::delta);
  writeTransforms(delta_, before_);
  writeVisibility(delta_, toggledNow_);
  return delta_;
}

const std::string& StreamEncoder::key() {
  begin(key_, MessageKind::key);
  writeTransforms(key_, zero_);
  writeVisibility(key_, toggled_);
  return key_;
}

}  // namespace spark::web
