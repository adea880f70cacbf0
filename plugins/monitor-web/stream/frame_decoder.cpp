#include "frame_decoder.h"

#include <fmt/format.h>

#include <algorithm>

#include "spark/error.h"
#include "stream_encoder.h"

namespace spark::web {

namespace {
constexpr int kMostBits = 30;

void check(bool right, const char* expected) {
  if (!right) throw Error(fmt::format("the frames are damaged: expected {}", expected));
}
}  // namespace

std::string_view ByteReader::raw(std::size_t n) {
  check(n <= bytes_.size(), "more bytes");
  const std::string_view out = bytes_.substr(0, n);
  bytes_.remove_prefix(n);
  return out;
}

std::uint64_t ByteReader::varint() {
  std::uint64_t out = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = number<std::uint8_t>();
    out |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return out;
  }
  throw Error("the frames are damaged: a number has no end");
}

std::int64_t ByteReader::signedVarint() {
  const std::uint64_t v = varint();
  return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
}

void FrameDecoder::begin(std::vector<Mount> mounts, std::vector<std::uint8_t> visible) {
  mounts_ = std::move(mounts);
  now_.assign(mounts_.size(), {});
  places_.assign(mounts_.size(), Matrix::Identity());
  visible_ = visibleAtKey_ = std::move(visible);
  hasKey_ = false;
}

double FrameDecoder::timeOf(std::string_view frame) {
  ByteReader in(frame);
  in.raw(4 + sizeof(std::uint32_t) + sizeof(std::uint32_t));
  return in.number<double>();
}

void FrameDecoder::take(std::string_view frame) {
  ByteReader in(frame);
  const auto kind = MessageKind{in.number<std::uint8_t>()};
  positionBits_ = in.number<std::uint8_t>();
  rotationBits_ = in.number<std::uint8_t>();
  check(positionBits_ <= kMostBits && rotationBits_ <= kMostBits, "at most 30 bits behind the point");
  in.number<std::uint8_t>();
  in.number<std::uint32_t>();
  const auto serial = in.number<std::uint32_t>();
  check(kind == MessageKind::key || (kind == MessageKind::delta && hasKey_ && serial == serial_ + 1),
        "a key, or what follows the frame before");
  serial_ = serial;
  time_ = in.number<double>();
  if (kind == MessageKind::key) {
    std::fill(now_.begin(), now_.end(), Quantised{});
    visible_ = visibleAtKey_;
  }
  hasKey_ = true;
  for (std::size_t at = 0;;) {
    const std::uint64_t skip = in.varint(), count = in.varint();
    if (count == 0) break;
    check(skip <= now_.size() - at && count <= now_.size() - at - skip, "transforms of the scene");
    at += skip;
    for (const std::size_t end = at + count; at < end; ++at) {
      const auto mask = in.number<std::uint8_t>();
      for (unsigned k = 0; k < now_[at].size(); ++k)
        if (mask >> k & 1)
          now_[at][k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(now_[at][k]) +
                                                  static_cast<std::uint32_t>(in.signedVarint()));
    }
  }
  for (std::uint64_t n = in.varint(); n > 0; --n) {
    const std::uint64_t node = in.varint();
    check(node < visible_.size(), "nodes of the scene");
    visible_[node] = in.number<std::uint8_t>() != 0;
  }
  place();
}

void FrameDecoder::place() {
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const Matrix& other = places_[static_cast<std::size_t>(std::max(mounts_[i].on, 0))];
    places_[i] = placeOf(now_[i], mounts_[i], other, {positionBits_, rotationBits_});
  }
}

PieceMessage PieceMessage::read(std::string_view message) {
  ByteReader in(message);
  const auto kind = MessageKind{in.number<std::uint8_t>()};
  check(kind == MessageKind::piece || kind == MessageKind::scene, "a piece or a scene");
  in.number<std::uint8_t>();
  const auto packing = in.number<std::uint8_t>();
  check(packing == 1, "content that is not compressed");
  in.number<std::uint8_t>();
  PieceMessage out;
  out.isScene = kind == MessageKind::scene;
  out.shape = in.number<std::uint32_t>();
  out.from = in.number<double>();
  out.to = in.number<double>();
  out.content = in.rest();
  return out;
}

void PieceMessage::forEach(const std::function<void(bool isFrame, std::string_view bytes)>& take) const {
  for (ByteReader in(content); !in.atEnd();) {
    const auto kind = in.number<std::uint8_t>();
    check(kind <= 1, "a text or a frame");
    take(kind == 1, in.raw(in.varint()));
  }
}

}  // namespace spark::web
