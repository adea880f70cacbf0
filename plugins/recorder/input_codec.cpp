#include "input_codec.h"

#include "spark/error.h"

namespace spark::recorder {

namespace {
// Signed numbers near zero become small unsigned ones.
std::uint64_t folded(std::int64_t v) {
  return (static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63);
}
std::int64_t unfolded(std::uint64_t v) { return static_cast<std::int64_t>((v >> 1) ^ (0 - (v & 1))); }

std::uint64_t takeNumber(std::string_view& bytes) {
  std::uint64_t out = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (bytes.empty()) break;
    const auto b = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    out |= static_cast<std::uint64_t>(b & 0x7f) << shift;
    if ((b & 0x80) == 0) return out;
  }
  throw Error("inputs are damaged: a number has no end");
}

std::string takeText(std::string_view& bytes) {
  const std::uint64_t n = takeNumber(bytes);
  if (n > bytes.size()) throw Error("inputs are damaged: a text is longer than what is left");
  std::string out(bytes.substr(0, n));
  bytes.remove_prefix(n);
  return out;
}

/// True if inputs of a kind have place, key and text; the others have a number only.
bool isLong(Input::Kind kind) { return kind != Input::Kind::cycle && kind != Input::Kind::time; }
}  // namespace

void InputWriter::number(std::uint64_t v) {
  for (; v >= 0x80; v >>= 7) bytes_ += static_cast<char>(v | 0x80);
  bytes_ += static_cast<char>(v);
}

void InputWriter::text(std::string_view v) {
  number(v.size());
  bytes_ += v;
}

void InputWriter::add(const Input& input) {
  bytes_ += static_cast<char>(input.kind);
  std::int64_t n = input.number;
  if (input.kind == Input::Kind::time) n -= std::exchange(lastTime_, n);
  number(folded(n));
  if (!isLong(input.kind)) return;
  text(input.place);
  number(input.key);
  text(input.text);
}

void readInputs(std::string_view bytes, std::vector<OwnInput>& out) {
  std::int64_t lastTime = 0;
  while (!bytes.empty()) {
    OwnInput in;
    const auto kind = static_cast<unsigned char>(bytes.front());
    if (kind > static_cast<unsigned>(Input::Kind::decision)) throw Error("inputs are damaged: an unknown kind");
    bytes.remove_prefix(1);
    in.kind = static_cast<Input::Kind>(kind);
    in.number = unfolded(takeNumber(bytes));
    if (in.kind == Input::Kind::time) in.number = lastTime += in.number;
    if (isLong(in.kind)) {
      in.place = takeText(bytes);
      in.key = takeNumber(bytes);
      in.text = takeText(bytes);
    }
    out.push_back(std::move(in));
  }
}

}  // namespace spark::recorder
