#pragma once
/// \file
/// Modifiers: models of imperfect sensors and effectors. The children of a perceptor or an effector that are modifiers
/// are a chain. It changes what the perceptor senses, or the actions before the effector executes them:
///
///     (nd GPS (setName gps) (nd WhiteNoise (setSigma 0.01)) (nd Delay (setCycles 3)))
///
///     sense() ─► WhiteNoise ─► Delay ─► message to the agent
///     message from the agent ─► first modifier ─► second one ─► act()

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/agents.h"
#include "api/math.h"
#include "api/measurement.h"
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
/// A perceptor may say what its numbers are (IMeasurement). Then the one that says that nothing was measured stays as
/// it is, the others stay within its limits, and a rotation stays a rotation: a modifier that adds to numbers turns it,
/// by what it would add to three numbers [rad, about x, y and z of the rotated frame]; one that does something else
/// leaves it as it is.
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
    measured_ = measurement_ ? measurement_->measured() : Measured{};
    if (measured_.kind == Measured::Kind::pixels) return;  // pixels() changes them
    found_ = false;
    for (const Element list : signal) changeIn(signal, list, event);
    watch(signal);
  }
  /// Changes the numbers of a picture, in their order; `measured`: which of them, and within which limits. For
  /// perceptors of Measured::Kind::pixels.
  template <class Number>
  void changePixels(std::span<Number> pixels, const Measured& measured, const Event& event) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double value = pixels[i];
      if (!changes(i) || value == measured.nothing) continue;
      const double result = std::round(change(value, i, event));
      if (std::isfinite(result)) pixels[i] = static_cast<Number>(std::clamp(result, measured.least, measured.most));
    }
  }

 protected:
  /// The largest number that properties of these classes may have, for ranges: neither infinite nor NaN.
  static constexpr double kMost = 1e15;
  /// The number that replaces `value`. `index`: which number of its list it is, from 0, as in the property `indices`.
  virtual double change(double value, std::size_t index, const Event& event) = 0;
  /// True: change() adds something that does not depend on `value`, so that it can turn a rotation.
  virtual bool adds() const { return false; }
  void onLink() override {
    Modifier::onLink();
    measurement_ = parent()->as<IMeasurement>();
  }

 private:
  static constexpr int kPatience = 50;  ///< percepts without a number to change, after which that is logged

  /// Changes the numbers in `list`, or in the fields inside of it.
  void changeIn(Signal& signal, const Element& list, const Event& event) {
    if (!list.isList()) return;
    if (field_.empty() || list.head() == field_) return changeAll(signal, list, event);
    for (const Element inner : list) changeIn(signal, inner, event);
  }
  /// Changes the numbers in `list`, at any depth.
  void changeAll(Signal& signal, const Element& list, const Event& event) {
    const std::uint32_t begin = list.index() + 1, end = list.index() + list.token().size;
    if (measured_.kind == Measured::Kind::rotation) return changeRotation(signal, begin, end, event);
    if (measured_.kind == Measured::Kind::pose) return changePose(signal, begin, end, event);
    std::size_t index = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Element e = signal.at(i);
      if (i == begin && e.isText()) continue;  // the name of the list
      const std::optional<double> value = numberOf(e, signal.kind());
      if (!value) continue;
      const std::size_t k = index++;
      found_ = true;
      if (!std::isfinite(*value) || *value == measured_.nothing || !changes(k)) continue;
      const double result = change(*value, k, event);
      if (signal.fits(e, result))
        signal.set(e, std::min(std::max(result, measured_.least), measured_.most));
      else
        warn(*value, result);
    }
  }
  /// The first numbers between two tokens, as many as `out` has. False if there are fewer.
  template <std::size_t N>
  bool numbersIn(Signal& signal, std::uint32_t begin, std::uint32_t end, std::array<std::uint32_t, N>& out) {
    std::size_t count = 0;
    for (std::uint32_t i = begin; i < end && count < N; ++i)
      if (signal.at(i).token().kind == Token::Kind::number) out[count++] = i;
    found_ = found_ || count > 0;
    return count == N;
  }
  /// A small rotation in the rotated frame; nullopt if this modifier leaves rotations as they are.
  std::optional<Eigen::Quaterniond> turn(const Event& event) {
    if (!adds()) {
      if (!std::exchange(warned_, true))
        kernel().log().warning(
            "{} ({}) leaves the rotation that {} senses as it is: only what adds to numbers can turn it. Take a Bias, "
            "a WhiteNoise or a RandomWalk, in rad.",
            path(), classObject()->name(), parent()->path());
      return std::nullopt;
    }
    Vec3 by = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      if (changes(static_cast<std::size_t>(k))) by[k] = change(0, static_cast<std::size_t>(k), event);
    const double angle = by.norm();
    if (!std::isfinite(angle) || angle == 0) return std::nullopt;
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, by / angle));
  }
  void changeRotation(Signal& signal, std::uint32_t begin, std::uint32_t end, const Event& event) {
    std::array<std::uint32_t, 4> at{};
    if (!numbersIn(signal, begin, end, at)) return;
    const auto number = [&](std::size_t i) { return signal.at(at[i]).number(); };
    const auto by = turn(event);
    if (!by) return;
    const Eigen::Quaterniond q = (Eigen::Quaterniond(number(0), number(1), number(2), number(3)) * *by).normalized();
    const double turned[] = {q.w(), q.x(), q.y(), q.z()};
    for (std::size_t i = 0; i < at.size(); ++i) signal.set(signal.at(at[i]), turned[i]);
  }
  /// Numbers 3, 7 and 11 are the position. The rotation changes with the others, by numbers 0 to 2.
  void changePose(Signal& signal, std::uint32_t begin, std::uint32_t end, const Event& event) {
    std::array<std::uint32_t, 16> at{};
    if (!numbersIn(signal, begin, end, at)) return;
    const auto element = [&](std::size_t row, std::size_t column) { return signal.at(at[4 * row + column]); };
    for (std::size_t row = 0; row < 3; ++row) {
      const std::size_t k = 4 * row + 3;
      if (!changes(k)) continue;
      const double value = element(row, 3).number(), result = change(value, k, event);
      signal.fits(element(row, 3), result) ? signal.set(element(row, 3), result) : warn(value, result);
    }
    if (!changes(0) && !changes(1) && !changes(2)) return;
    const auto by = turn(event);
    if (!by) return;
    Mat3 rotation;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) rotation(row, column) = element(row, column).number();
    rotation = rotation * by->toRotationMatrix();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) signal.set(element(row, column), rotation(row, column));
  }
  /// Logs once that there is no number to change.
  void watch(const Signal& signal) {
    if (found_ || idle_ > kPatience) idle_ = kPatience + 1;
    if (idle_ > kPatience || signal.kind() != Signal::Kind::percept || signal.empty() || ++idle_ < kPatience) return;
    idle_ = kPatience + 1;
    kernel().log().warning(
        "{} ({}) has changed nothing so far: the percepts of {} have no number with decimals{}. Integers change where "
        "the property 'field' names their list.",
        path(), classObject()->name(), parent()->path(),
        field_.empty() ? std::string() : fmt::format(" in a list '{}'", field_));
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
  const IMeasurement* measurement_ = nullptr;  ///< of the perceptor above; nullptr: it is none, or says nothing
  Measured measured_;                          ///< during apply()
  bool found_ = false;                         ///< during apply(): there was a number
  int idle_ = 0;                               ///< percepts without one; above kPatience: no longer counted
};

}  // namespace spark
