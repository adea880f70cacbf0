#pragma once
/// \file
/// References to objects of the tree.

#include <cstddef>
#include <type_traits>
#include <utility>

#include "spark/abi/spark/ref.h"
#include "spark/assert.h"
#include "spark/interface.h"

namespace spark {

class Leaf;

namespace detail {
/// Outlives its leaf while references remain; `leaf` is nulled when the leaf dies.
struct Life {
  Leaf* leaf;
  unsigned references;
};
/// The life of a leaf, with one reference more.
Life* shareLife(const Leaf& leaf);
}  // namespace detail

/// An object of the tree, as the leaf that it is and as the T that it offers.
template <class T>
struct Found {
  Found(std::nullptr_t = nullptr) {}
  Found(T* o, Leaf* l) : object(o), leaf(l) {}
  T* object = nullptr;
  Leaf* leaf = nullptr;
  /// Precondition of -> and *: it is not empty.
  T* operator->() const { return SPARK_ASSERT(object), object; }
  std::add_lvalue_reference_t<T> operator*() const { return SPARK_ASSERT(object), *object; }
  explicit operator bool() const { return object != nullptr; }
  operator T*() const { return object; }
};

/// A checked, non-owning reference: empty once the object died. Copy and assign it on the simulation's thread; read it
/// anywhere.
template <class T>
class Ref {
 public:
  Ref() = default;
  Ref(T* object);
  Ref(const Found<T>& found);
  Ref(const Ref& other) noexcept : life_(other.life_), object_(other.object_) {
    if (life_) ++life_->references;
  }
  Ref(Ref&& other) noexcept
      : life_(std::exchange(other.life_, nullptr)), object_(std::exchange(other.object_, nullptr)) {}
  Ref& operator=(const Ref& other) {
    if (other.life_) ++other.life_->references;
    release();
    life_ = other.life_;
    object_ = other.object_;
    return *this;
  }
  ~Ref() { release(); }

  /// The object, or nullptr when it is dead or was never set.
  T* get() const { return life_ && life_->leaf ? object_ : nullptr; }
  /// Precondition of -> and *: it is not empty.
  T* operator->() const { return SPARK_ASSERT(get()), get(); }
  T& operator*() const { return SPARK_ASSERT(get()), *get(); }
  explicit operator bool() const { return get() != nullptr; }

 private:
  void release() {
    if (life_ && --life_->references == 0) delete life_;
  }
  detail::Life* life_ = nullptr;
  T* object_ = nullptr;
};

template <class T>
Ref<T>::Ref(const Found<T>& found) : object_(found.object) {
  if (found) life_ = detail::shareLife(*found.leaf);
}

template <class T>
Ref<T>::Ref(T* object) : object_(object) {
  if (!object) return;
  if constexpr (std::is_base_of_v<Leaf, T>)
    life_ = detail::shareLife(*object);
  else
    life_ = detail::shareLife(object->leaf());
}

}  // namespace spark
