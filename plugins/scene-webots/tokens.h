#pragma once
/// \file
/// The tokens of Webots files.

#include <string>
#include <string_view>

#include "robot/document.h"
#include "template_text.h"

namespace spark::webots {

/// A word, a number, a text in quotes, one of { } [ ], or the end of the file.
struct Token {
  enum class Kind { word, number, text, sign, end };
  Kind kind = Kind::end;
  std::size_t offset = 0;
  std::string text{};  ///< without quotes and escapes; one character for a sign
  double number = 0;
  bool is(char sign) const { return kind == Kind::sign && text[0] == sign; }
  bool isWord(std::string_view word) const { return kind == Kind::word && text == word; }
  /// What it is, for errors: 'children', the end of the file.
  std::string named() const;
};

/// Cuts a file into tokens, one at a time. Commas and comments separate them.
class Tokens {
 public:
  /// `file` must outlive this. Throws Error as next() does.
  explicit Tokens(const mjcf::File& file);
  /// Those of a text that a template of the file has written, which must outlive this.
  Tokens(const mjcf::File& file, const Expansion& expansion);
  const Token& peek() const { return token_; }
  /// Returns the present token and goes on to the next one. Throws Error with file:line:column for bytes that are no
  /// token, and for statements of templates outside of PROTOs.
  Token next();
  /// Goes on at a place of the file.
  void skipTo(std::size_t offset);

 private:
  void skipSpace();
  void read();
  void readText();
  void readWord();
  void refuseTemplate(std::size_t at) const;
  std::size_t offsetOf(std::size_t at) const { return expansion_ ? expansion_->offsetOf(at) : at; }
  const mjcf::File& file_;
  const Expansion* expansion_ = nullptr;
  std::string_view text_;
  std::size_t at_ = 0;
  Token token_;
};

}  // namespace spark::webots
