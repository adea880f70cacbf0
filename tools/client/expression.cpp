#include "spark/client/expression.h"

#include <cstdlib>

namespace spark::client {

namespace {
constexpr int kDeepest = 256;
const Expression kNone;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool endsAtom(char c) { return isBlank(c) || c == '(' || c == ')' || c == '"'; }

/// Parses a message.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}
  /// Adds the next expression to `out`. False at the end, and when there is none.
  bool next(Expression& out, int depth) {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
    if (at_ == text_.size() || text_[at_] == ')') return false;
    if (text_[at_] == '(') return list(out, depth);
    out.add(Expression(text_[at_] == '"' ? quoted() : plain()));
    return true;
  }

 private:
  bool list(Expression& out, int depth) {
    if (depth == kDeepest) return false;
    ++at_;
    Expression inner;
    while (next(inner, depth + 1)) {
    }
    if (at_ == text_.size() || text_[at_] != ')') return false;
    ++at_;
    out.add(std::move(inner));
    return true;
  }
  std::string plain() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !endsAtom(text_[at_])) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }
  std::string quoted() {
    std::string out;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      out += text_[at_];
    }
    if (at_ < text_.size()) ++at_;
    return out;
  }
  std::string_view text_;
  std::size_t at_ = 0;
};
}  // namespace

double Expression::number() const { return std::strtod(text_.c_str(), nullptr); }

const Expression& Expression::operator[](std::size_t i) const { return i < items_.size() ? items_[i] : kNone; }

const Expression& Expression::find(std::string_view name) const {
  for (const Expression& e : items_)
    if (e.isList() && e.name() == name) return e;
  return kNone;
}

Expression read(std::string_view message) {
  Expression out;
  Reader reader(message);
  while (reader.next(out, 0)) {
  }
  return out;
}

}  // namespace spark::client
