#include "tokens.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "syntax.h"

namespace spark::webots {

namespace {
constexpr std::string_view kSpace = " \t\r\n,", kSigns = "{}[]";
constexpr std::size_t kShown = 40;  ///< characters of a token in errors

bool beginsNumber(std::string_view text) {
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const std::size_t digit = sign + (text.substr(sign).starts_with('.') ? 1 : 0);
  return digit < text.size() && text[digit] >= '0' && text[digit] <= '9';
}

}  // namespace

std::string Token::named() const {
  if (kind == Kind::end) return "the end of the file";
  const std::string shown = text.substr(0, kShown);
  return kind == Kind::text ? fmt::format("\"{}\"", shown) : fmt::format("'{}'", shown);
}

Tokens::Tokens(const mjcf::File& file) : file_(file), text_(file.text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  if (text_.starts_with(kMark)) at_ = kMark.size();
  read();
}

Tokens::Tokens(const mjcf::File& file, const Expansion& expansion)
    : file_(file), expansion_(&expansion), text_(expansion.text) {
  read();
}

void Tokens::skipTo(std::size_t offset) {
  at_ = std::min(offset, text_.size());
  read();
}

Token Tokens::next() {
  Token out = std::move(token_);
  read();
  return out;
}

void Tokens::skipSpace() {
  while (at_ < text_.size()) {
    if (text_[at_] == '#')
      at_ = std::min(text_.find('\n', at_), text_.size());
    else if (kSpace.find(text_[at_]) != std::string_view::npos)
      ++at_;
    else
      return;
  }
}

void Tokens::read() {
  skipSpace();
  token_ = {};
  token_.offset = offsetOf(at_);
  if (at_ == text_.size()) return;
  refuseTemplate(at_);
  if (text_[at_] == '"') return readText();
  if (kSigns.find(text_[at_]) == std::string_view::npos) return readWord();
  token_.kind = Token::Kind::sign;
  token_.text = text_[at_++];
}

void Tokens::readText() {
  token_.kind = Token::Kind::text;
  for (std::size_t i = at_ + 1; i < text_.size(); ++i) {
    refuseTemplate(i);
    if (text_[i] == '"') {
      at_ = i + 1;
      return;
    }
    if (text_[i] == '\\' && i + 1 < text_.size()) ++i;
    token_.text += text_[i];
  }
  throw errorAt(file_, token_.offset, "expected a \" at the end of the text, found the end of the file");
}

void Tokens::readWord() {
  std::size_t end = at_;
  while (end < text_.size() && (kSpace.find(text_[end]) == std::string_view::npos) &&
         kSigns.find(text_[end]) == std::string_view::npos && text_[end] != '"' && text_[end] != '#') {
    refuseTemplate(end);
    ++end;
  }
  token_.text = text_.substr(at_, end - at_);
  token_.kind = Token::Kind::word;
  at_ = end;
  if (!beginsNumber(token_.text)) return;
  token_.kind = Token::Kind::number;
  const char* const begin = token_.text.data() + (token_.text.starts_with('+') ? 1 : 0);
  const char* const last = token_.text.data() + token_.text.size();
  const auto [stop, failure] = std::from_chars(begin, last, token_.number);
  if (failure != std::errc() || stop != last || !std::isfinite(token_.number))
    throw errorAt(file_, token_.offset, fmt::format("expected a number, found {}", token_.named()));
}

/// %< >% and %{ }% are programs that write the node of a PROTO.
void Tokens::refuseTemplate(std::size_t at) const {
  const std::string_view rest = text_.substr(at, 2);
  if (rest == "%<" || rest == "%{")
    throw errorAt(file_, offsetOf(at),
                  fmt::format("'{}' begins a statement of a template, which only the node of a PROTO may have", rest));
}

}  // namespace spark::webots
