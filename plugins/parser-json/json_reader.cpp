#include "parser-json/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "spark/numbers.h"

namespace spark::json {

namespace {

/// Input iterator for nlohmann's parser. Its position is stored outside of it, so that reading can continue with the
/// next value after the parser has finished one.
class Cursor {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Cursor(std::string_view bytes, std::size_t& at) : bytes_(bytes), at_(&at) {}
  reference operator*() const { return bytes_[*at_]; }
  Cursor& operator++() {
    ++*at_;
    return *this;
  }
  /// True until all bytes are read. `end` may be any cursor over the same bytes, because only the number of bytes is
  /// used.
  bool operator!=(const Cursor& end) const { return *at_ < end.bytes_.size(); }
  bool operator==(const Cursor& end) const { return !(*this != end); }

 private:
  std::string_view bytes_;
  std::size_t* at_;
};

/// Replaces UTF-8 by a byte for each character. False if one is behind U+00FF.
bool toBytes(std::string& text) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c > 0xC3) return false;
    // The reader of JSON has checked that a second byte follows.
    text[to++] = c < 0x80 ? text[i] : static_cast<char>((c & 3) << 6 | (text[++i] & 0x3F));
  }
  text.resize(to);
  return true;
}

/// Builds predicates from nlohmann's events. The first element of a top-level array decides whether the array is a
/// predicate or contains predicates; before it, the array is `undecided_`.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(Predicates& out, const ReadLimits& limits, bool binary)
      : out_(out), limits_(limits), binary_(binary), first_(out.size()), complete_(out.size()) {}

  bool null() override { return add(std::numeric_limits<double>::quiet_NaN()); }
  bool boolean(bool v) override { return add(std::string_view(v ? "true" : "false")); }
  bool number_integer(number_integer_t v) override { return add(static_cast<std::int64_t>(v)); }
  bool number_unsigned(number_unsigned_t v) override {
    if (v > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return add(static_cast<double>(v));
    return add(static_cast<std::int64_t>(v));
  }
  bool number_float(number_float_t v, const string_t&) override { return add(static_cast<double>(v)); }
  bool string(string_t& v) override {
    return !binary_ || toBytes(v) ? addText(v)
                                  : fail("a character behind U+00FF is no byte: the parser is set to binary");
  }
  bool binary(binary_t&) override { return fail("binary data is no part of the language"); }
  bool start_object(std::size_t) override {
    return fail("objects are no part of the language; write [\"name\", value]");
  }
  bool key(string_t&) override { return fail("objects are no part of the language"); }
  bool end_object() override { return fail("objects are no part of the language"); }

  bool start_array(std::size_t) override {
    if (depth_ == limits_.maxDepth) return fail(fmt::format("lists nested deeper than {}", limits_.maxDepth));
    if (depth_ == 0) {
      undecided_ = true;
    } else {
      if (undecided_) contains_ = true, undecided_ = false;
      if (full()) return false;
      out_.open();
    }
    ++depth_;
    return true;
  }
  bool end_array() override {
    --depth_;
    const bool outer = depth_ == 0;
    if (!outer || (!undecided_ && !contains_)) out_.close();
    if (outer || (contains_ && depth_ == 1)) complete_ = out_.size();
    if (outer) undecided_ = contains_ = false;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& e) override {
    const std::string_view what = e.what();
    const auto end = what.find("] ");
    return fail(std::string(end == what.npos ? what : what.substr(end + 2)));
  }

  /// What is wrong; "" if nothing is.
  const std::string& message() const { return message_; }
  /// True after the limit of tokens.
  bool isFull() const { return isFull_; }
  /// The predicates that were read last are gone from the buffer.
  void restart() { complete_ = out_.size(); }
  /// Removes an incomplete predicate, and is ready for the next value.
  void dropUnfinished() {
    out_.truncate(complete_);
    depth_ = 0;
    undecided_ = contains_ = false;
  }

 private:
  /// S-expressions need quotes around what is no word, or would be a number without them.
  bool addText(std::string_view text) {
    double number = 0;
    return add(text, !isWord(text) || readWholeNumber(text, number));
  }
  template <class... Atom>
  bool add(Atom... atom) {
    if (full()) return false;
    if (undecided_) out_.open(), undecided_ = false;
    out_.add(atom...);
    if (depth_ == 0) complete_ = out_.size();
    return true;
  }
  bool full() {
    isFull_ = out_.size() - first_ >= limits_.maxTokens;
    if (!isFull_) return false;
    fail(fmt::format("more than {} tokens", limits_.maxTokens));
    return true;
  }
  bool fail(std::string message) {
    message_ = std::move(message);
    return false;
  }

  Predicates& out_;
  const ReadLimits& limits_;
  const bool binary_;
  const std::uint32_t first_;  ///< size of `out_` at the beginning
  std::uint32_t complete_;     ///< end of the last complete predicate in `out_`
  std::uint32_t depth_ = 0;
  bool undecided_ = false;  ///< in a top-level array before its first element
  bool contains_ = false;   ///< in a top-level array that contains predicates
  bool isFull_ = false;
  std::string message_;
};

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// The byte behind the array that begins at `at`, npos if it has no end; where no array begins, the next one. Without
/// `quotes` brackets count even in texts.
std::size_t findEnd(std::string_view bytes, std::size_t at, bool quotes) {
  if (bytes[at] != '[') return std::min(bytes.find('[', at), bytes.size());
  std::size_t depth = 0;
  bool isQuoted = false;
  for (; at < bytes.size(); ++at) {
    const char c = bytes[at];
    if (isQuoted && c == '\\' && at + 1 < bytes.size())
      ++at;
    else if (quotes && c == '"')
      isQuoted = !isQuoted;
    else if (!isQuoted && c == '[')
      ++depth;
    else if (!isQuoted && c == ']' && --depth == 0)
      return at + 1;
  }
  return std::string_view::npos;
}

/// Reads a message around its mistakes.
class Reader {
 public:
  Reader(std::string_view bytes, Predicates& out, const ReadLimits& limits, bool binary)
      : bytes_(bytes), builder_(out, limits, binary), out_(out) {}

  ReadResult read() {
    std::size_t at = 0;
    for (;;) {
      skipBlanks(at);
      if (at >= bytes_.size()) break;
      const std::size_t begin = at;
      const std::uint32_t before = out_.size();
      if (parse(bytes_, at)) continue;
      noteMistake(at);
      if (!mayGoOn()) break;
      const std::size_t end = endOf(begin);
      if (end == std::string_view::npos) break;
      at = end;
      if (!isContainer(begin)) continue;
      // Read the predicates inside again, each by itself.
      out_.truncate(before);
      builder_.restart();
      if (!readInside(begin + 1, end - 1)) break;
    }
    result_.consumed = at;
    return std::move(result_);
  }

 private:
  /// Parses one value. What is incomplete is removed.
  bool parse(std::string_view bytes, std::size_t& at) {
    if (nlohmann::json::sax_parse(Cursor(bytes, at), Cursor(bytes, at), &builder_, nlohmann::json::input_format_t::json,
                                  false))
      return true;
    builder_.dropUnfinished();
    return false;
  }
  /// Parses the values of an array. False if the rest of the message is lost.
  bool readInside(std::size_t at, std::size_t end) {
    while (at < end) {
      skipBlanks(at);
      if (at >= end) break;
      const std::size_t next = std::min(endOf(at), end);
      if (bytes_[at] == '[') {
        const std::string alone = "[" + std::string(bytes_.substr(at, next - at)) + "]";
        std::size_t ignored = 0;
        if (!parse(alone, ignored) && !mayGoOn()) return false;
      }
      at = next;
    }
    return true;
  }
  void skipBlanks(std::size_t& at) const {
    while (at < bytes_.size() && isBlank(bytes_[at])) ++at;
  }
  /// A quote that does not end may be the mistake. Then brackets count even behind quotes, and so they do from then on.
  std::size_t endOf(std::size_t begin) {
    const std::size_t end = quotes_ ? findEnd(bytes_, begin, true) : std::string_view::npos;
    if (end != std::string_view::npos) return end;
    quotes_ = false;
    return findEnd(bytes_, begin, false);
  }
  bool isContainer(std::size_t begin) const {
    if (bytes_[begin++] != '[') return false;
    skipBlanks(begin);
    return begin < bytes_.size() && bytes_[begin] == '[';
  }
  bool mayGoOn() { return !builder_.isFull() && ++mistakes_ < kMostMistakes; }
  /// Keeps the first mistake.
  void noteMistake(std::size_t at) {
    if (!result_.message.empty()) return;
    result_.message = builder_.message();
    result_.line = 1;
    result_.column = static_cast<std::uint32_t>(at) + 1;
    for (std::size_t i = 0; i < at; ++i)
      if (bytes_[i] == '\n') ++result_.line, result_.column = static_cast<std::uint32_t>(at - i);
  }

  static constexpr int kMostMistakes = 100;  ///< each may cost a pass over the message
  std::string_view bytes_;
  Builder builder_;
  Predicates& out_;
  ReadResult result_;
  bool quotes_ = true;
  int mistakes_ = 0;
};

}  // namespace

ReadResult read(std::string_view bytes, Predicates& out, const ReadLimits& limits, bool binary) {
  return Reader(bytes, out, limits, binary).read();
}

}  // namespace spark::json
