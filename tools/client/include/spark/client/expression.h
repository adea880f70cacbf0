#pragma once
/// \file
/// A tree of S-expressions, read from a server's message.

#include <string>
#include <string_view>
#include <vector>

namespace spark::client {

/// An atom, or a list of expressions: `(HJ (n hj1) (ax -12.5))`.
class Expression {
 public:
  /// An empty list.
  Expression() = default;
  /// An atom.
  explicit Expression(std::string text) : text_(std::move(text)), isAtom_(true) {}

  bool isAtom() const { return isAtom_; }
  bool isList() const { return !isAtom_; }
  /// The text of an atom; "" for lists.
  const std::string& text() const { return text_; }
  /// The number at the start of the atom; 0 when there is none.
  double number() const;

  /// A list's elements.
  const std::vector<Expression>& items() const { return items_; }
  std::size_t size() const { return items_.size(); }
  /// Element i of a list; an empty list when there is none.
  const Expression& operator[](std::size_t i) const;
  /// The text of a list's first element: its name.
  const std::string& name() const { return (*this)[0].text(); }
  /// The first list of that name inside this one; an empty list when there is none: `hinge.find("ax")[1].number()`.
  const Expression& find(std::string_view name) const;

  /// Appends an element to a list.
  void add(Expression item) { items_.push_back(std::move(item)); }

 private:
  std::string text_;
  std::vector<Expression> items_;
  bool isAtom_ = false;
};

/// Reads a message into a list of its top-level expressions. Atoms may be "quoted". An error (an extra bracket, an
/// unclosed list, more than 256 levels) ends the result; the expressions before it are kept.
Expression read(std::string_view message);

}  // namespace spark::client
