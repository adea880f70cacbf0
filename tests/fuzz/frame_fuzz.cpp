// The frame reader. Frames lie within the input, consume at least one byte, respect the size limit, and can be framed
// again with the same bytes.
#include <cstdint>
#include <cstdlib>

#include "net-tcp/length_prefix_framing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Status = spark::IFraming::Frame::Status;
  constexpr std::size_t kLimit = 300;
  spark::LengthPrefixFraming framing;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (;;) {
    const auto frame = framing.take(bytes, kLimit);
    if (frame.status == Status::bad && frame.why.empty()) std::abort();
    if (frame.status != Status::message) break;
    if (frame.consumed == 0 || frame.consumed > bytes.size() || frame.message.size() > kLimit) std::abort();
    if (frame.message.data() < bytes.data() ||
        frame.message.data() + frame.message.size() > bytes.data() + frame.consumed)
      std::abort();
    std::string again;
    framing.frame(frame.message, again);
    if (again != bytes.substr(0, frame.consumed)) std::abort();
    bytes.remove_prefix(frame.consumed);
  }
  return 0;
}
