#include "template_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "syntax.h"

namespace spark::webots {

namespace {

constexpr std::string_view kBlank = " \t\r\n";

std::string_view opening(Language language) { return language == Language::lua ? "%{" : "%<"; }
std::string_view closing(Language language) { return language == Language::lua ? "}%" : ">%"; }

/// Where the next statement begins in the text from `at` on, or npos. `inText`: whether `at` is between quotes, and
/// whether the place is. Comments, which prevail over statements, are skipped.
std::size_t nextStatement(std::string_view text, std::size_t at, std::string_view mark, bool& inText) {
  for (; at < text.size(); ++at) {
    if (text.substr(at).starts_with(mark)) return at;
    if (text[at] == '"') inText = !inText;
    if (text[at] == '\\' && inText) ++at;
    if (text[at] == '#' && !inText) at = std::min(text.find('\n', at), text.size() - 1);
  }
  return std::string_view::npos;
}

/// The language of the first statement in the text, before the } that closes it; nullopt where there is none.
std::optional<Language> firstLanguage(std::string_view text) {
  bool inText = false;
  int open = 1;
  for (std::size_t i = 0; i < text.size() && open > 0; ++i) {
    const std::string_view rest = text.substr(i, 2);
    if (rest == "%<") return Language::javascript;
    if (rest == "%{") return Language::lua;
    if (text[i] == '"') inText = !inText;
    if (text[i] == '\\' && inText) ++i;
    if (inText) continue;
    if (text[i] == '#')
      i = std::min(text.find('\n', i), text.size());
    else
      open += text[i] == '{' ? 1 : text[i] == '}' ? -1 : 0;
  }
  return std::nullopt;
}

/// Makes the program of a template.
class Splitter {
 public:
  Splitter(const mjcf::File& file, std::size_t begin, std::size_t end, Language language)
      : file_(file), text_(std::string_view(file.text).substr(0, end)), at_(begin) {
    out_.language = language;
    out_.lines.push_back(begin);
  }
  Template split();

 private:
  void addLiteral(std::size_t end, bool nextIsStatement);
  void addStatement();
  void program(std::string_view text, std::size_t offset);
  void newline(std::size_t offset) {
    out_.program += '\n';
    out_.lines.push_back(offset);
  }

  const mjcf::File& file_;
  const std::string_view text_;
  std::size_t at_;
  bool afterStatement_ = true;  ///< what is before at_ writes nothing
  Template out_;
};

Template Splitter::split() {
  for (bool inText = false;;) {
    const std::size_t mark = nextStatement(text_, at_, opening(out_.language), inText);
    if (mark == std::string_view::npos) break;
    addLiteral(mark, mark + 2 < text_.size() && text_[mark + 2] != '=');
    addStatement();
  }
  addLiteral(text_.size(), true);
  return std::move(out_);
}

/// Text of the file, with lines of the program that are those of the file.
void Splitter::program(std::string_view text, std::size_t offset) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n')
      newline(offset + i + 1);
    else
      out_.program += text[i];
  }
}

void Splitter::addLiteral(std::size_t end, bool nextIsStatement) {
  const std::string_view text = text_.substr(at_, end - at_);
  // Space between two statements means nothing; in Javascript, none may be written between } and else.
  const bool isSpace = text.find_first_not_of(kBlank) == std::string_view::npos;
  if (!text.empty() && !(isSpace && afterStatement_ && nextIsStatement)) {
    newline(at_);
    out_.program += fmt::format("spark{}write({})", out_.language == Language::lua ? '_' : '$', out_.pieces.size());
    out_.program += ';';
    out_.pieces.push_back({at_, text.size()});
    newline(end);
  }
  at_ = end;
}

void Splitter::addStatement() {
  const std::size_t begin = at_;
  const bool isValue = begin + 2 < text_.size() && text_[begin + 2] == '=';
  const std::size_t inner = begin + (isValue ? 3 : 2);
  const std::size_t end = text_.find(closing(out_.language), inner);
  if (end == std::string_view::npos)
    throw errorAt(file_, begin,
                  fmt::format("expected a {} behind this statement of a template", closing(out_.language)));
  const std::string_view text = text_.substr(inner, end - inner);
  const bool lua = out_.language == Language::lua;
  newline(begin);
  // The newlines end statements without a semicolon, and comments.
  if (isValue) {
    // As in Webots, a value in Javascript may end with a semicolon.
    out_.program += lua ? fmt::format("spark_write({}, (", out_.pieces.size()) : std::string("{ spark$value = ");
    program(text, inner);
    newline(begin);
    out_.program += lua ? std::string("));") : fmt::format("; spark$write({}, spark$value); }}", out_.pieces.size());
    out_.pieces.push_back({begin, end + 2 - begin, true});
  } else {
    program(text, inner);
  }
  newline(end);
  at_ = end + 2;
  afterStatement_ = !isValue;
}

}  // namespace

std::size_t Expansion::offsetOf(std::size_t at) const {
  const auto behind = std::upper_bound(parts.begin(), parts.end(), at,
                                       [](std::size_t place, const Part& p) { return place < p.begin; });
  if (behind == parts.begin()) return at;
  const Part& part = *(behind - 1);
  return part.offset + (part.runs ? at - part.begin : 0);
}

bool Template::add(Expansion& out, const mjcf::File& file, std::size_t number, const std::string& value) const {
  if (number >= pieces.size()) return false;
  const Piece& piece = pieces[number];
  out.parts.push_back({out.text.size(), piece.offset, !piece.isValue});
  out.text += piece.isValue ? value : file.text.substr(piece.offset, piece.size);
  return true;
}

std::optional<Template> templateIn(const mjcf::File& file, std::size_t begin, std::size_t end) {
  const std::string_view text(file.text);
  std::optional<Language> language = firstLanguage(text.substr(begin, end - begin));
  if (!language) return std::nullopt;
  if (text.substr(0, begin).find("template language: javascript") != std::string_view::npos)
    language = Language::javascript;
  return Splitter(file, begin, end, *language).split();
}

}  // namespace spark::webots
