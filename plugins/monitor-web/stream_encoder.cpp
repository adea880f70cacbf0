#include "stream_encoder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>

namespace spark::web {

static_assert(std::endian::native == std::endian::little, "frames are little endian");

namespace {
constexpr std::uint8_t kKey = 1, kDelta = 2;
constexpr std::size_t kWorthSkipping = 3;  // unchanged transforms that cost more as empty masks than as a new run
// A value moves to another step only when it is this far from the one it has: what trembles around the middle of two
// stays.
constexpr float kHold = 0.75f;
constexpr float kLargest = 1 << 30;

template <class T>
void putRaw(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::int32_t step(float exact, std::int32_t before) {
  if (!std::isfinite(exact)) return before;
  if (std::abs(exact - static_cast<float>(before)) <= kHold) return before;
  return static_cast<std::int32_t>(std::lround(std::clamp(exact, -kLargest, kLargest)));
}

/// Scaled and sheared matrices give the rotation nearest to them; what is none at all, none.
Eigen::Vector4f rotationOf(const Matrix& m) {
  const Eigen::Matrix3f r = m.block<3, 3>(0, 0);
  const Eigen::Vector4f q = Eigen::Quaternionf(r).normalized().coeffs();
  return q.allFinite() && q.squaredNorm() > 0.5f ? q : Eigen::Vector4f(0, 0, 0, 1);
}
}  // namespace

void putVarint(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<char>(value | 0x80));
  out.push_back(static_cast<char>(value));
}

void putSigned(std::string& out, std::int64_t value) {
  putVarint(out, static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
}

StreamEncoder::Quantised StreamEncoder::quantise(const Matrix& m, const Quantised& before) const {
  const float perMetre = std::ldexp(1.f, precision_.position), perUnit = std::ldexp(1.f, precision_.rotation);
  Quantised out;
  for (int i = 0; i < 3; ++i) out[i] = step(m(i, 3) * perMetre, before[i]);
  const Eigen::Vector4f q = rotationOf(m) * perUnit;
  const Eigen::Vector4f last(static_cast<float>(before[3]), static_cast<float>(before[4]),
                             static_cast<float>(before[5]), static_cast<float>(before[6]));
  const float sign = q.dot(last) < 0 ? -1.f : 1.f;  // both signs are one rotation: the nearer one is
  for (int i = 0; i < 4; ++i) out[3 + i] = step(sign * q[i], before[3 + i]);
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
  for (std::size_t i = 0; i < size; ++i) now_[i] = quantise(instant.transforms[i], before_[i]);
  flickers_.assign(instant.flickers.begin(), instant.flickers.end());
  flickered_.clear();
  for (const std::uint32_t node : flickers_)
    if (hasDelta_ && visible_[node] != instant.visible[node]) flickered_.push_back(node);
  visible_.assign(instant.visible.begin(), instant.visible.end());
  shape_ = instant.shape;
  time_ = instant.time;
  ++serial_;
}

void StreamEncoder::begin(std::string& out, std::uint8_t kind) const {
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
    while (begin < size && same(begin)) ++begin;
    if (begin == size) break;
    std::size_t end = begin + 1;  // of the run: behind its last change
    for (std::size_t i = end; i < size && i < end + kWorthSkipping; ++i)
      if (!same(i)) end = i + 1;
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
  begin(delta_, kDelta);
  writeTransforms(delta_, before_);
  writeVisibility(delta_, flickered_);
  return delta_;
}

const std::string& StreamEncoder::key() {
  begin(key_, kKey);
  writeTransforms(key_, zero_);
  writeVisibility(key_, flickers_);
  return key_;
}

}  // namespace spark::web
