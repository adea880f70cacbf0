// Packets of the drawing port. For any input, the stored shapes are valid and within limits, and a record of them can
// be read back.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "../../plugins/drawing/draw_board.h"
#include "../../plugins/drawing/draw_packet.h"

namespace {
using namespace spark;
using drawing::PacketReader;

void check(bool holds) {
  if (!holds) std::abort();
}

void check(const Drawing& d) {
  for (const Vec3f& p : d.points)
    for (int i = 0; i < 3; ++i) check(std::abs(p[i]) <= PacketReader::kMaxCoordinate);
  check(d.size >= 0 && std::isfinite(d.size) && d.thickness >= 0 && std::isfinite(d.thickness));
  check(d.text.size() <= PacketReader::kMaxTextBytes && drawing::cleanText(d.text, d.text.size()) == d.text);
}

void take(std::string_view bytes, drawing::DrawBoard& board, bool mustRead) {
  PacketReader reader(std::as_bytes(std::span(bytes.data(), bytes.size())));
  for (drawing::Command c; reader.next(c);) {
    check(c.drawing);
    check(c.set.size() <= PacketReader::kMaxNameBytes);
    if (c.kind == drawing::Command::Kind::swap) board.swap(c.set);
    if (c.kind == drawing::Command::Kind::draw) board.add(c.set, c.drawing);
    if (c.kind == drawing::Command::Kind::agentText) board.setAgentText(c.drawing);
  }
  check(!mustRead || !reader.failed());
}

void replay(std::string_view record, drawing::DrawBoard& board) {
  while (!record.empty()) {
    check(record.front() == '[');
    std::string bytes;
    const char* at = record.data();
    do {
      char* end = nullptr;
      bytes += static_cast<char>(std::strtol(at + 1, &end, 10));
      at = end;
    } while (*at == ',');
    check(*at == ']');
    record.remove_prefix(static_cast<std::size_t>(at + 1 - record.data()));
    take(bytes, board, true);
  }
}

std::size_t shapes(const drawing::DrawBoard& board) {
  std::size_t sum = 0;
  for (const auto& set : board.sets()) sum += set.shapes.size();
  return sum;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  drawing::DrawBoard board, again;
  take({reinterpret_cast<const char*>(data), size}, board, false);
  board.swap("");
  std::string record;
  board.record(0, record);
  replay(record, again);
  check(record.size() > drawing::DrawBoard::kMaxRecordBytes || shapes(again) == shapes(board));
  return 0;
}
