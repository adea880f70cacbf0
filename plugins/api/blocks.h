#pragma once
/// \file
/// Blocks of plain data that single engines know of the elements of a model. Nodes make them: api/extension.h.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "spark/abi/api/blocks.h"

namespace spark::engine {

/// The identity of a kind of block: of its name (FNV-1a).
constexpr std::uint64_t kindOf(std::string_view name) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

/// The numbers of one kind.
struct Block {
  std::uint64_t kind = 0;
  std::vector<double> data;  ///< the bytes of a struct
  /// `T`: a struct of numbers of eight bytes, with a name of its own in `kKind`. Blocks of several in one element, such
  /// as the axes of a joint, are told apart by `number`.
  template <class T>
  static Block of(const T& value, int number = 0) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
    Block b{kindOf<T>(number), std::vector<double>(sizeof(T) / sizeof(double))};
    std::memcpy(b.data.data(), &value, sizeof value);
    return b;
  }
  template <class T>
  static constexpr std::uint64_t kindOf(int number = 0) {
    constexpr std::uint64_t kKind = engine::kindOf(T::kKind);
    return kKind + static_cast<std::uint64_t>(number);
  }
  /// Its numbers; the default values if it has not as many.
  template <class T>
  T as() const {
    T out{};
    if (data.size() * sizeof(double) == sizeof out) std::memcpy(static_cast<void*>(&out), data.data(), sizeof out);
    return out;
  }
};

/// The blocks of an element.
class Blocks {
 public:
  /// The block of a type, its default values if there is none.
  template <class T>
  T get(int number = 0) const {
    for (const Block& b : blocks_)
      if (b.kind == Block::kindOf<T>(number)) return b.as<T>();
    return {};
  }
  /// Those of a type with numbers below `numbers`, each with its number, in the order in which they were set.
  template <class T>
  std::vector<std::pair<int, T>> all(int numbers) const {
    std::vector<std::pair<int, T>> out;
    for (const Block& b : blocks_)
      if (const std::uint64_t number = b.kind - kindOf(T::kKind); number < static_cast<std::uint64_t>(numbers))
        out.emplace_back(static_cast<int>(number), b.as<T>());
    return out;
  }
  void set(const Block& block) {
    remove(block.kind);
    blocks_.push_back(block);
  }
  void remove(std::uint64_t kind) {
    std::erase_if(blocks_, [kind](const Block& b) { return b.kind == kind; });
  }
  bool empty() const { return blocks_.empty(); }

 private:
  std::vector<Block> blocks_;
};

}  // namespace spark::engine
