#pragma once
/// \file
/// Reads pieces and scenes of the history and of recordings as a viewer does.

#include <zstd.h>

#include "frame_reader.h"

namespace spark::web::test {

/// A piece, or a scene, which has no frames. Throws std::runtime_error if the message is malformed.
struct ReadPiece {
  explicit ReadPiece(std::string_view message) {
    if (message.size() < 24) throw std::runtime_error("expected a head");
    isScene = message[0] == 4;
    complete = message[1] == 1;
    std::memcpy(&shape, message.data() + 4, sizeof shape);
    std::memcpy(&from, message.data() + 8, sizeof from);
    std::memcpy(&to, message.data() + 16, sizeof to);
    const std::string_view packed = message.substr(24);
    const std::string content = message[2] == 1 ? std::string(packed) : unpacked(packed);
    if (isScene)
      texts.push_back(content);
    else
      read(content);
  }

  bool isScene = false, complete = false;
  std::uint32_t shape = 0;
  double from = 0, to = 0;
  std::vector<std::string> texts, frames;

 private:
  static std::string unpacked(std::string_view packed) {
    const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size > (64u << 20)) throw std::runtime_error("expected the size of the content");
    std::string content(size, '\0');
    if (ZSTD_decompress(content.data(), size, packed.data(), packed.size()) != size)
      throw std::runtime_error("expected a frame of zstd");
    return content;
  }
  void read(std::string_view content) {
    while (!content.empty()) {
      const bool frame = content[0] == 1;
      std::size_t size = 0, at = 1;
      for (int shift = 0;; shift += 7) {
        const auto byte = static_cast<unsigned char>(content.at(at++));
        size |= std::size_t{byte & 0x7fu} << shift;
        if (byte < 0x80) break;
      }
      (frame ? frames : texts).emplace_back(content.substr(at, size));
      content.remove_prefix(at + size);
    }
  }
};

}  // namespace spark::web::test
