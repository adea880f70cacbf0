#include "parser-json/json_reader.h"

#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

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

/// Builds predicates from nlohmann's events. The first element of a top-level array decides whether the array is a
/// predicate or contains predicates; before it, the array is `undecided_`.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(Predicates& out, const ReadLimits& limits)
      : out_(out), limits_(limits), first_(out.size()), complete_(out.size()) {}

  bool null() override { return add(std::numeric_limits<double>::quiet_NaN()); }
  bool boolean(bool v) override { return add(std::string_view(v ? "true" : "false")); }
  bool number_integer(number_integer_t v) override { return add(static_cast<std::int64_t>(v)); }
  bool number_unsigned(number_unsigned_t v) override {
    if (v > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return add(static_cast<double>(v));
    return add(static_cast<std::int64_t>(v));
  }
  bool number_float(number_float_t v, const string_t&) override { return add(static_cast<double>(v)); }
  bool string(string_t& v) override { return add(std::string_view(v)); }
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
  /// Removes an incomplete predicate.
  void dropUnfinished() { out_.truncate(complete_); }

 private:
  template <class T>
  bool add(T atom) {
    if (full()) return false;
    if (undecided_) out_.open(), undecided_ = false;
    out_.add(atom);
    if (depth_ == 0) complete_ = out_.size();
    return true;
  }
  bool full() {
    if (out_.size() - first_ < limits_.maxTokens) return false;
    fail(fmt::format("more than {} tokens", limits_.maxTokens));
    return true;
  }
  bool fail(std::string message) {
    message_ = std::move(message);
    return false;
  }

  Predicates& out_;
  const ReadLimits& limits_;
  const std::uint32_t first_;  ///< size of `out_` at the beginning
  std::uint32_t complete_;     ///< end of the last complete predicate in `out_`
  std::uint32_t depth_ = 0;
  bool undecided_ = false;  ///< in a top-level array before its first element
  bool contains_ = false;   ///< in a top-level array that contains predicates
  std::string message_;
};

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

ReadResult read(std::string_view bytes, Predicates& out, const ReadLimits& limits) {
  ReadResult result;
  std::size_t at = 0;
  Builder builder(out, limits);
  for (;;) {
    while (at < bytes.size() && isBlank(bytes[at])) ++at;
    if (at >= bytes.size()) break;
    if (!nlohmann::json::sax_parse(Cursor(bytes, at), Cursor(bytes, at), &builder, nlohmann::json::input_format_t::json,
                                   false)) {
      builder.dropUnfinished();
      result.message = builder.message();
      result.line = 1;
      result.column = static_cast<std::uint32_t>(at) + 1;
      for (std::size_t i = 0; i < at; ++i)
        if (bytes[i] == '\n') ++result.line, result.column = static_cast<std::uint32_t>(at - i);
      break;
    }
  }
  result.consumed = at;
  return result;
}

}  // namespace spark::json
