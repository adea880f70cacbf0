#pragma once
/// \file
/// State: every property marked `state()` and what `saveState` writes, in tree order. Hash: 64 bits, raw bits of
/// doubles, no names.
///
/// Saved form: for each node, bases first, its state properties as Values, then what saveState wrote. Shape (classes,
/// names, children) is not part of it: it is loaded into a tree of the same shape.

#include <cstdint>
#include <string>
#include <string_view>

#include "spark/abi/spark/state.h"
#include "spark/value.h"

namespace spark {

class Leaf;

/// Takes state as raw bytes; with `keep` false only the hash is made.
class StateWriter {
 public:
  explicit StateWriter(bool keep) : keep_(keep) {}
  void write(double v);
  void write(std::int64_t v);
  void write(std::uint64_t v) { write(static_cast<std::int64_t>(v)); }
  void write(int v) { write(static_cast<std::int64_t>(v)); }
  void write(bool v) { write(static_cast<std::int64_t>(v)); }
  void write(std::string_view v);
  void write(const char* v) { write(std::string_view(v)); }
  void write(const Value& v);
  /// Hash of all that was written so far.
  std::uint64_t hash() const;
  const std::string& bytes() const { return bytes_; }

 private:
  void word(std::uint64_t w);
  std::uint64_t a_ = 0x9e3779b97f4a7c15ull, count_ = 0;
  bool keep_;
  std::string bytes_;
};

/// Reads what StateWriter kept, in the same order. Throws Error when the bytes end early or a value has another type.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}
  double readNumber();
  std::int64_t readInteger();
  bool readBool() { return readInteger() != 0; }
  std::string readString();
  Value readValue();
  bool atEnd() const { return bytes_.empty(); }

 private:
  std::uint64_t word();
  std::string_view bytes_;
};

/// The state hash of a subtree.
std::uint64_t stateHash(const Leaf& root);
/// Saves and restores the state of a subtree. loadTree throws Error when the shape differs.
void saveTree(const Leaf& root, StateWriter& out);
void loadTree(Leaf& root, StateReader& in);

}  // namespace spark
