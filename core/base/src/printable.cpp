#include "spark/printable.h"

#include <fmt/format.h>

namespace spark {

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const unsigned char next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    if (byte == 0xc2 && next >= 0x80 && next < 0xa0)
      out += fmt::format("\\x{:02x}\\x{:02x}", byte, next), ++i;
    else if (byte == '\n' || byte == '\t' || (byte >= 0x20 && byte != 0x7f))
      out += text[i];
    else
      out += fmt::format("\\x{:02x}", byte);
  }
  return out;
}

}  // namespace spark
