#include "spark/state_stream.h"

#include <fmt/format.h>

#include <bit>

#include "spark/error.h"

namespace spark {

void StateWriter::keep(std::uint64_t w) {
  char bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>(w >> (8 * i));
  bytes_.append(bytes, 8);
}

void StateWriter::write(std::string_view v) {
  // The length, then eight bytes in a word; the last word is filled with zeros.
  word(v.size());
  const auto bytes = [&v](std::size_t count) {
    std::uint64_t w = 0;
    for (std::size_t k = 0; k < count; ++k)
      w |= static_cast<std::uint64_t>(static_cast<unsigned char>(v[k])) << (8 * k);
    return w;
  };
  for (; v.size() >= 8; v.remove_prefix(8)) word(bytes(8));
  if (!v.empty()) word(bytes(v.size()));
}

void StateWriter::write(const std::vector<std::string>& v) {
  word(static_cast<std::uint64_t>(Value::Type::list));
  word(v.size());
  for (const std::string& s : v) {
    word(static_cast<std::uint64_t>(Value::Type::string));
    write(std::string_view(s));
  }
}

void StateWriter::write(const Value& v) {
  word(static_cast<std::uint64_t>(v.type()));
  switch (v.type()) {
    case Value::Type::nil:
      break;
    case Value::Type::boolean:
      write(v.toBool());
      break;
    case Value::Type::integer:
      write(v.toInteger());
      break;
    case Value::Type::number:
      write(v.toNumber());
      break;
    case Value::Type::string:
      write(std::string_view(v.toString()));
      break;
    case Value::Type::list:
      word(v.toList().size());
      for (const Value& e : v.toList()) write(e);
  }
}

void StateWriter::aside(std::string_view v) {
  if (!keep_) return;
  const auto a = a_, count = count_;
  write(v);
  a_ = a, count_ = count;
}

std::uint64_t StateWriter::hash() const {
  // MurmurHash3's finaliser.
  std::uint64_t h = a_ ^ count_;
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ull;
  return h ^ (h >> 33);
}

std::uint64_t StateReader::word() {
  if (bytes_.size() < 8) throw Error("saved state ends early");
  std::uint64_t w = 0;
  for (int i = 0; i < 8; ++i) w |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[i])) << (8 * i);
  bytes_.remove_prefix(8);
  return w;
}

double StateReader::readNumber() { return std::bit_cast<double>(word()); }
std::int64_t StateReader::readInteger() { return static_cast<std::int64_t>(word()); }

std::size_t StateReader::readCount() {
  const std::uint64_t n = word();
  if (n > bytes_.size() / 8) throw Error("saved state ends early");
  return n;
}

std::string StateReader::readString() {
  const std::uint64_t n = word();
  if (n > bytes_.size()) throw Error("saved state ends early");
  std::string out;
  while (out.size() < n) {
    const std::uint64_t w = word();
    for (int k = 0; k < 8 && out.size() < n; ++k) out.push_back(static_cast<char>(w >> (8 * k)));
  }
  return out;
}

namespace {
/// Lists in lists, in a call of readValue().
constexpr int kMostLevels = 1000;
thread_local int levels = 0;
struct Inside {
  Inside() {
    if (++levels <= kMostLevels) return;
    --levels;
    throw Error(fmt::format("saved state holds more than {} lists in each other", kMostLevels));
  }
  ~Inside() { --levels; }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;
};
}  // namespace

Value StateReader::readValue() {
  // The numbers of Value::Type, which saved files contain.
  switch (const std::uint64_t type = word()) {
    case 0:
      return {};
    case 1:
      return readBool();
    case 2:
      return readInteger();
    case 3:
      return readNumber();
    case 4:
      return readString();
    case 5: {
      const Inside inside;
      List list;
      for (std::uint64_t n = word(); n > 0; --n) list.push_back(readValue());
      return list;
    }
    default:
      throw Error(fmt::format("saved state holds a value of unknown type {}", type));
  }
}

}  // namespace spark
