#pragma once
/// \file
/// Says in a test that a text lacks a word, and how often a text has it. A look that finds nothing may be blind: the
/// word is spelt differently, the text is compressed, or empty. Hence absence has a control, a text that the same look
/// gets where the word belongs (docs/testing.md).

#include <ostream>
#include <string>
#include <string_view>
#include <utility>

namespace spark::test {

/// How often `text` has `word`.
inline int count(std::string_view text, std::string_view word) {
  int n = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// What lacks() finds: true, or a sentence on what is wrong, which a failed CHECK prints.
class Absence {
 public:
  explicit Absence(std::string fault) : fault_(std::move(fault)) {}
  explicit operator bool() const { return fault_.empty(); }
  friend std::ostream& operator<<(std::ostream& out, const Absence& a) {
    return out << (a.fault_.empty() ? "it is lacking" : a.fault_);
  }

 private:
  std::string fault_;
};

/// True if `text` does not have `word` while `control` has it: what the same look showed at another time, of another
/// object, or with another setting.
inline Absence lacks(std::string_view text, std::string_view word, std::string_view control) {
  const auto quoted = [](std::string_view t) { return "\"" + std::string(t) + "\""; };
  if (text.find(word) != text.npos) return Absence(quoted(word) + " is in " + quoted(text));
  if (control.find(word) == control.npos)
    return Absence("this check cannot fail: " + quoted(word) + " is not in the control either: " + quoted(control));
  return Absence("");
}

}  // namespace spark::test
