#pragma once
/// \file
/// Decodes the binary frames of the stream, and the pieces of recordings.

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "api/math.h"
#include "stream_encoder.h"

namespace spark::web {

/// Takes bytes from the front. Throws Error where there are too few.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  bool atEnd() const { return bytes_.empty(); }
  std::string_view rest() const { return bytes_; }
  std::string_view raw(std::size_t n);
  /// A number, little endian.
  template <class T>
  T number() {
    T out;
    raw(sizeof out).copy(reinterpret_cast<char*>(&out), sizeof out);
    return out;
  }
  std::uint64_t varint();
  std::int64_t signedVarint();

 private:
  std::string_view bytes_;
};

/// The scene that a stream of frames shows.
class FrameDecoder {
 public:
  /// Begins with a scene. `mounts`: one for each of its transforms; `visible`: of each node.
  void begin(std::vector<Mount> mounts, std::vector<std::uint8_t> visible);
  /// Takes a frame. Throws Error if it is malformed, or if it belongs to another scene or to another frame before.
  void take(std::string_view frame);
  /// Time of the last frame [s].
  double time() const { return time_; }
  /// Local matrix of transform i, counted in node order.
  const Matrix& transform(std::size_t i) const { return places_.at(i); }
  /// Visibility of each node.
  const std::vector<std::uint8_t>& visible() const { return visible_; }
  /// Time of a frame [s], without the rest. Throws Error if it is none.
  static double timeOf(std::string_view frame);

 private:
  void place();
  std::vector<Mount> mounts_;
  std::vector<Quantised> now_;
  std::vector<Matrix> places_;
  std::vector<std::uint8_t> visible_, visibleAtKey_;
  int positionBits_ = 0, rotationBits_ = 0;
  std::uint32_t serial_ = 0;
  double time_ = 0;
  bool hasKey_ = false;
};

/// A piece of the match, or a scene, as recordings have them: README.md. The views are of the message.
struct PieceMessage {
  bool isScene = false;
  std::uint32_t shape = 0;   ///< number of the scene
  double from = 0, to = 0;   ///< s
  std::string_view content;  ///< JSON of the scene, or the records
  /// Reads a message. Throws Error if it is malformed, or compressed.
  static PieceMessage read(std::string_view message);
  /// Calls `take` for each record of a piece, frames and texts, in order. Throws Error if they are malformed.
  void forEach(const std::function<void(bool isFrame, std::string_view bytes)>& take) const;
};

}  // namespace spark::web
