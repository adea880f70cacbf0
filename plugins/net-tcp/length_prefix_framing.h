#pragma once
/// \file
/// The framing of the SimSpark protocol: a length of four bytes, big-endian, then as many bytes.

#include <fmt/format.h>

#include "api/net.h"
#include "spark/describe.h"

namespace spark {

/// A message follows its length, a 4-byte big-endian integer. Length 0 is legal and gives an empty message.
class LengthPrefixFraming : public Leaf, public IFraming {
  SPARK_CLASS(LengthPrefixFraming, Leaf)
 public:
  static constexpr std::size_t kPrefix = 4;  ///< bytes

  static void describe(Description<LengthPrefixFraming>& d) {
    d.doc("Splits a byte stream into messages, each after its 4-byte big-endian length.");
    d.implements<IFraming>();
  }

  Frame take(std::string_view bytes, std::size_t limit) override {
    Frame frame;
    if (bytes.size() < kPrefix) return frame;
    std::size_t length = 0;
    for (std::size_t i = 0; i < kPrefix; ++i) length = length << 8 | static_cast<unsigned char>(bytes[i]);
    if (length > limit) {
      frame.status = Frame::Status::bad;
      frame.why =
          fmt::format("announces a message of {} bytes, at most {} are taken (a 4-byte big-endian length is expected)",
                      length, limit);
    } else if (bytes.size() - kPrefix >= length) {
      frame.status = Frame::Status::message;
      frame.consumed = kPrefix + length;
      frame.message = bytes.substr(kPrefix, length);
    }
    return frame;
  }

  void frame(std::string_view message, std::string& out) override {
    const auto n = static_cast<std::uint32_t>(message.size());
    const char prefix[kPrefix] = {static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8),
                                  static_cast<char>(n)};
    out.append(prefix, kPrefix).append(message);
  }
};

}  // namespace spark
