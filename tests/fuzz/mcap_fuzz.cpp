// Recordings: MCAP files, and the inputs and frames in them; pieces of inputs alone, as no chunk hides them by its CRC.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "../../plugins/monitor-web/stream/frame_decoder.h"
#include "../../plugins/recorder/input_codec.h"
#include "../../plugins/recorder/mcap.h"
#include "spark/error.h"

namespace {
void readPiece(std::string_view bytes) {
  try {
    spark::recorder::InputReader reader;
    std::vector<spark::recorder::OwnInput> out;
    reader.read(bytes, out);
    spark::recorder::InputWriter writer;
    std::vector<spark::recorder::OwnInput> again;
    spark::recorder::InputReader second;
    for (const std::string& piece : writer.write(out)) second.read(piece, again);
    if (again != out) std::abort();
  } catch (const spark::Error&) {
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  readPiece({reinterpret_cast<const char*>(data), size});
  static const int file = memfd_create("recording", 0);
  static const std::string name = "/proc/self/fd/" + std::to_string(file);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  try {
    spark::mcap::Reader reader(name);
    spark::recorder::InputReader inputs;
    for (const auto& chunk : reader.chunks())
      reader.forEach(chunk, [&](const spark::mcap::Message& m) {
        std::vector<spark::recorder::OwnInput> out;
        try {
          inputs.read(m.data, out);
        } catch (const spark::Error&) {
        }
        try {
          spark::web::FrameDecoder decoder;
          std::vector<spark::web::Mount> mounts(8);
          mounts[5].on = 2, mounts[6].on = 5;
          decoder.begin(mounts, std::vector<std::uint8_t>(8));
          spark::web::PieceMessage::read(m.data).forEach([&](bool isFrame, std::string_view bytes) {
            if (isFrame) decoder.take(bytes);
          });
        } catch (const spark::Error&) {
        }
        return true;
      });
    for (const auto& attachment : reader.attachments()) {
      try {
        if (reader.read(attachment).size() != attachment.length) std::abort();
      } catch (const spark::Error&) {
      }
    }
  } catch (const spark::Error&) {
  }
  return 0;
}
