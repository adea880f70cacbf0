#include "input_codec.h"

#include "spark/error.h"

namespace spark::recorder {

namespace {
// Signed numbers near zero become small unsigned ones.
std::uint64_t folded(std::int64_t v) {
  return (static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63);
}
std::int64_t unfolded(std::uint64_t v) { return static_cast<std::int64_t>((v >> 1) ^ (0 - (v & 1))); }

void putNumber(std::string& out, std::uint64_t v) {
  for (; v >= 0x80; v >>= 7) out += static_cast<char>(v | 0x80);
  out += static_cast<char>(v);
}

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

constexpr std::int64_t kMostTime = std::int64_t{1} << 53;  // us

constexpr char kMostDecimals = 6;
constexpr std::uint64_t kMostDigits = 1u << 31;  // the number that they are is less
constexpr unsigned char kPlain = 0x80;           // of a kind
constexpr std::size_t kPlanes = 4, kMostLengthBytes = 10;

bool isMark(char c) { return c >= 1 && c <= kMostDecimals; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// A decimal number at the front of a text that is written back with the same characters. length 0: there is none.
struct Decimal {
  std::size_t length = 0;
  std::uint32_t code = 0;
  char decimals = 0;
};

Decimal decimalAt(std::string_view text) {
  std::size_t at = text.starts_with('-') ? 1 : 0;
  const std::size_t first = at;
  std::uint64_t digits = 0;
  const auto read = [&] {
    for (; at < text.size() && isDigit(text[at]) && digits < kMostDigits; ++at)
      digits = 10 * digits + static_cast<std::uint64_t>(text[at] - '0');
  };
  read();
  if (at == first || at == text.size() || text[at] != '.' || (text[first] == '0' && at > first + 1)) return {};
  const std::size_t point = at++;
  read();
  const std::size_t decimals = at - point - 1;
  if (decimals == 0 || decimals > kMostDecimals || digits >= kMostDigits) return {};
  if (at < text.size() && isDigit(text[at])) return {};
  return {at, static_cast<std::uint32_t>(2 * digits + first), static_cast<char>(decimals)};
}

void putDecimal(std::string& out, std::uint32_t code, char decimals) {
  if (code & 1) out += '-';
  std::string digits = std::to_string(code >> 1);
  const std::size_t n = static_cast<unsigned char>(decimals);
  if (digits.size() <= n) digits.insert(0, n + 1 - digits.size(), '0');
  out.append(digits, 0, digits.size() - n).append(1, '.').append(digits, digits.size() - n, n);
}

/// The numbers of a piece, in their order.
class Decimals {
 public:
  explicit Decimals(std::string_view planes) : planes_(planes), count_(planes.size() / kPlanes) {
    if (planes.size() % kPlanes != 0) throw Error("inputs are damaged: a number lacks bytes");
  }
  std::uint32_t take() {
    if (at_ == count_) throw Error("inputs are damaged: a text has more numbers than there are");
    std::uint32_t out = 0;
    for (std::size_t p = 0; p < kPlanes; ++p)
      out |= std::uint32_t{static_cast<unsigned char>(planes_[p * count_ + at_])} << (8 * p);
    ++at_;
    return out;
  }

 private:
  std::string_view planes_;
  std::size_t count_, at_ = 0;
};

/// A text with its numbers.
std::string filled(std::string_view text, Decimals& numbers) {
  std::string out;
  for (const char c : text)
    if (isMark(c))
      putDecimal(out, numbers.take(), c);
    else
      out += c;
  return out;
}
}  // namespace

void InputWriter::text(std::string_view v) {
  putNumber(bytes_, v.size());
  bytes_ += v;
}

/// Puts the text without its numbers into template_. False if it must stand as it is.
bool InputWriter::split(std::string_view text) {
  const std::size_t before = decimals_.size();
  template_.clear();
  bool inside = false;  // a number: its digits are no beginning of another one
  while (!text.empty()) {
    const Decimal found = inside ? Decimal{} : decimalAt(text);
    if (found.length > 0) {
      template_ += found.decimals;
      decimals_.push_back(found.code);
      text.remove_prefix(found.length);
      inside = true;
      continue;
    }
    const char c = text.front();
    if (isMark(c)) {
      decimals_.resize(before);
      return false;
    }
    inside = isDigit(c) || c == '.';
    template_ += c;
    text.remove_prefix(1);
  }
  return true;
}

void InputWriter::add(const Input& input) {
  const auto kind = static_cast<unsigned char>(input.kind);
  const bool isSplit = isLong(input.kind) && split(input.text);
  bytes_ += static_cast<char>(isLong(input.kind) && !isSplit ? kind | kPlain : kind);
  std::int64_t n = input.number;
  if (input.kind == Input::Kind::time) n -= std::exchange(lastTime_, n);
  putNumber(bytes_, folded(n));
  if (!isLong(input.kind)) return;
  text(input.place);
  putNumber(bytes_, input.key);
  text(isSplit ? template_ : input.text);
}

std::string InputWriter::take() {
  lastTime_ = 0;
  std::string out;
  if (bytes_.empty()) return out;
  out.reserve(kMostLengthBytes + bytes_.size() + kPlanes * decimals_.size());
  putNumber(out, bytes_.size());
  out += bytes_;
  for (std::size_t p = 0; p < kPlanes; ++p)
    for (const std::uint32_t v : decimals_) out += static_cast<char>(v >> (8 * p));
  bytes_.clear();
  decimals_.clear();
  return out;
}

void readInputs(std::string_view piece, std::vector<OwnInput>& out) {
  if (piece.empty()) return;
  const std::uint64_t size = takeNumber(piece);
  if (size > piece.size()) throw Error("inputs are damaged: they are longer than what is left");
  std::string_view bytes = piece.substr(0, size);
  Decimals numbers(piece.substr(size));
  std::int64_t lastTime = 0;
  while (!bytes.empty()) {
    OwnInput in;
    const auto first = static_cast<unsigned char>(bytes.front());
    const unsigned kind = first & ~unsigned{kPlain};
    if (kind > static_cast<unsigned>(Input::Kind::decision)) throw Error("inputs are damaged: an unknown kind");
    bytes.remove_prefix(1);
    in.kind = static_cast<Input::Kind>(kind);
    in.number = unfolded(takeNumber(bytes));
    if (in.kind == Input::Kind::time) {
      const auto fits = [](std::int64_t t) { return t <= kMostTime && t >= -kMostTime; };
      if (!fits(in.number) || !fits(lastTime + in.number)) throw Error("inputs are damaged: a time is out of range");
      in.number = lastTime += in.number;
    }
    if (isLong(in.kind)) {
      in.place = takeText(bytes);
      in.key = takeNumber(bytes);
      in.text = takeText(bytes);
      if ((first & kPlain) == 0) in.text = filled(in.text, numbers);
    }
    out.push_back(std::move(in));
  }
}

}  // namespace spark::recorder
