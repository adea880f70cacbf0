#pragma once
/// \file
/// Messages as lines of text, for clients that are written in a few lines themselves.

#include <fmt/format.h>

#include <algorithm>

#include "api/net.h"
#include "spark/describe.h"

namespace spark {

/// A message is a line: it ends with a line feed, before which a carriage return is ignored. Empty lines give empty
/// messages. Line feeds within a message that is sent become spaces, which mean the same in S-expressions and JSON.
class LineFraming : public Leaf, public IFraming {
  SPARK_CLASS(LineFraming, Leaf)
 public:
  static void describe(Description<LineFraming>& d) {
    d.doc("Splits a byte stream into messages, each a line.");
    d.implements<IFraming>();
  }

  Frame take(std::string_view bytes, std::size_t limit) override {
    Frame frame;
    const std::size_t end = bytes.find('\n');
    std::size_t length = std::min(end, bytes.size());
    if (length > 0 && bytes[length - 1] == '\r') --length;
    if (length > limit) {
      frame.status = Frame::Status::bad;
      frame.why = fmt::format("sends a line of {}{} bytes, at most {} are taken (a line per message is expected)",
                              end == bytes.npos ? "more than " : "", end == bytes.npos ? limit : length, limit);
    } else if (end != bytes.npos) {
      frame.status = Frame::Status::message;
      frame.consumed = end + 1;
      frame.message = bytes.substr(0, length);
    }
    return frame;
  }

  void frame(std::string_view message, std::string& out) override {
    const std::size_t start = out.size();
    out.append(message);
    std::replace(out.begin() + static_cast<std::ptrdiff_t>(start), out.end(), '\n', ' ');
    out += '\n';
  }
};

}  // namespace spark
