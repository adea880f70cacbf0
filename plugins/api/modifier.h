#pragma once
/// \file
/// Modifiers: models of imperfect sensors and effectors. The children of a perceptor or an effector that are modifiers
/// are a chain. It changes what the perceptor senses, or the actions before the effector executes them:
///
///     (nd GPS (setName gps) (nd WhiteNoise (setSigma 0.01)) (nd Delay (setCycles 3)))
///
///     sense() ─► WhiteNoise ─► Delay ─► message to the agent
///     message from the agent ─► first modifier ─► second one ─► act()

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "spark/abi/api/modifier.h"

namespace spark {

/// What a perceptor senses in one cycle, or the actions for an effector in one cycle: usually one list or none, but
/// there may be several. A view of the last lists of a buffer; valid during one call of Modifier::apply().
class Signal {
 public:
  /// What the lists are.
  enum class Kind : std::uint8_t { percept, action };
  /// The lists of `buffer` from token `first` on. `buffer` must outlive the signal.
  Signal(Kind kind, Predicates& buffer, std::uint32_t first) : kind_(kind), buffer_(buffer), first_(first) {}
  /// What the lists are.
  Kind kind() const { return kind_; }
  /// True if there is no list.
  bool empty() const { return buffer_.size() == first_; }
  /// The first list.
  Element::Iterator begin() const { return {buffer_, first_}; }
  /// Behind the last list.
  Element::Iterator end() const { return buffer_.end(); }
  /// The number of tokens.
  std::uint32_t size() const { return buffer_.size() - first_; }
  /// Removes all lists.
  void clear() { buffer_.truncate(first_); }
  /// Adds a copy of a list of another buffer.
  void append(const Element& list) { buffer_.append(list); }
  /// True if set() can store the value: it is finite and, for an integer of a percept, in the range of integers.
  bool fits(const Element& number, double value) const {
    return std::isfinite(value) && (!rounds(number) || std::abs(value) < 0x1p63);
  }
  /// Replaces a number of the signal. An integer of a percept stays one: it gets the nearest integer.
  void set(const Element& number, double value) {
    const bool whole = rounds(number);
    buffer_.set(number.index(), whole ? std::round(value) : value);
    if (whole) buffer_.set(number.index(), number.integer());
  }
  /// The element whose first token has that index.
  Element at(std::uint32_t index) const { return {buffer_, index}; }

 private:
  bool rounds(const Element& number) const {
    return kind_ == Kind::percept && number.token().kind == Token::Kind::integer;
  }
  Kind kind_;
  Predicates& buffer_;
  std::uint32_t first_;
};

/// Changes the signal of the perceptor or effector above it. Registered by `gamecontrol`.
class Modifier : public SceneNode {
  SPARK_CLASS(Modifier, SceneNode)
 public:
  static void describe(Description<Modifier>& d) {
    d.doc("Changes what the perceptor above it senses, or the actions for the effector above it.");
    d.abstract();
  }
  /// Changes the signal. Called once in each cycle of the agent, also with an empty signal: the perceptor was not due,
  /// there was no action, or a modifier before this one removed them. Of a perceptor it runs in the sense phase, where
  /// several threads may each handle one agent: it may read the world and change only itself. Of an effector it runs in
  /// the act phase. Must not throw.
  virtual void apply(Signal& signal, const Event& event) = 0;

 protected:
  void onLink() override {
    if (parent()->as<Perceptor>() || parent()->as<Effector>()) return;
    kernel().log().warning("{} has no effect: expected a perceptor or an effector as its parent, found {} ({}).",
                           path(), parent()->path(), parent()->classObject()->name());
  }
};

/// A modifier that changes numbers one by one; all others keep what they are. Registered by `gamecontrol`.
///
/// Which numbers there are:
///
///     percept    what the perceptor wrote as a number with decimals: names, ids and flags stay as they are. If `field`
///                is set, the integers of that list are numbers, too
///     action     what can be read as a number: in an action numbers may be texts
///
/// Numbers that are not finite stay as they are, and so do numbers whose result is not finite or, for an integer, does
/// not fit into one; the first such result of a modifier is logged.
class NumberModifier : public Modifier {
  SPARK_CLASS(NumberModifier, Modifier)
 public:
  static void describe(Description<NumberModifier>& d) {
    d.doc("Changes numbers of a percept or an action.");
    d.property("field", &NumberModifier::field_)
        .doc("Name of the inner lists whose numbers change, such as rt; empty: the whole percept or action.");
    d.property("indices", &NumberModifier::indices_)
        .min(0)
        .doc("Which of these numbers change, from 0; empty: all of them.");
    d.abstract();
  }
  void apply(Signal& signal, const Event& event) final {
    for (const Element list : signal) changeIn(signal, list, event);
  }

 protected:
  /// The largest number that properties of these classes may have, for ranges: neither infinite nor NaN.
  static constexpr double kMost = 1e15;
  /// The number that replaces `value`. `index`: which number of its list it is, from 0, as in the property `indices`.
  virtual double change(double value, std::size_t index, const Event& event) = 0;

 private:
  /// Changes the numbers in `list`, or in the fields inside of it.
  void changeIn(Signal& signal, const Element& list, const Event& event) {
    if (!list.isList()) return;
    if (field_.empty() || list.head() == field_) return changeAll(signal, list, event);
    for (const Element inner : list) changeIn(signal, inner, event);
  }
  /// Changes the numbers in `list`, at any depth.
  void changeAll(Signal& signal, const Element& list, const Event& event) {
    const std::uint32_t begin = list.index() + 1, end = list.index() + list.token().size;
    std::size_t index = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Element e = signal.at(i);
      if (i == begin && e.isText()) continue;  // the name of the list
      const std::optional<double> value = numberOf(e, signal.kind());
      if (!value) continue;
      const std::size_t k = index++;
      if (!std::isfinite(*value) || !changes(k)) continue;
      if (const double result = change(*value, k, event); signal.fits(e, result))
        signal.set(e, result);
      else
        warn(*value, result);
    }
  }
  /// Logs once that a number stays as it is.
  void warn(double value, double result) {
    if (std::exchange(warned_, true)) return;
    kernel().log().warning(
        "{} ({}) would make {} of {}, which cannot be sent: such numbers stay as they are. Check its properties. This "
        "is logged once.",
        path(), classObject()->name(), result, value);
  }
  std::optional<double> numberOf(const Element& e, Signal::Kind kind) const {
    const Token::Kind token = e.token().kind;
    const bool counts = kind == Signal::Kind::action || token == Token::Kind::number ||
                        (token == Token::Kind::integer && !field_.empty());
    return counts ? e.asNumber() : std::nullopt;
  }
  bool changes(std::size_t index) const {
    return indices_.empty() || std::find(indices_.begin(), indices_.end(), static_cast<int>(index)) != indices_.end();
  }

  std::string field_;
  std::vector<int> indices_;
  bool warned_ = false;
};

}  // namespace spark
