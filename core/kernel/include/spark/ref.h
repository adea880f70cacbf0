#pragma once
/// \file
/// References to objects of the tree, which become empty when the object is destroyed.

#include <cstddef>
#include <type_traits>
#include <utility>

#include "spark/abi/spark/ref.h"
#include "spark/assert.h"
#include "spark/interface.h"

namespace spark {

class Leaf;

namespace detail {
/// Shared by a leaf and the references to it. It is deleted with the last of them.
struct Life {
  Leaf* leaf;  ///< nullptr when the leaf has been destroyed
  unsigned references;
};
/// The Life of a leaf, with one more reference counted.
Life* shareLife(const Leaf& leaf);
}  // namespace detail

/// An object of the tree as T, together with its leaf. Not a reference: valid as long as the object.
template <class T>
struct Found {
  /// Nothing.
  Found(std::nullptr_t = nullptr) {}
  /// The object `o` of leaf `l`.
  Found(T* o, Leaf* l) : object(o), leaf(l) {}
  T* object = nullptr;
  Leaf* leaf = nullptr;
  /// The object. Precondition: not empty.
  T* operator->() const { return SPARK_ASSERT(object), object; }
  /// The object. Precondition: not empty.
  std::add_lvalue_reference_t<T> operator*() const { return SPARK_ASSERT(object), *object; }
  /// True if there is an object.
  explicit operator bool() const { return object != nullptr; }
  /// The object, or nullptr.
  operator T*() const { return object; }
};

/// A non-owning reference that becomes empty when its object is destroyed. Copy and assign it on the simulation's
/// thread only; any thread may read it.
template <class T>
class Ref {
 public:
  /// An empty reference.
  Ref() = default;
  /// A reference to an object, which may be nullptr.
  Ref(T* object);
  /// A reference to an object that was found, or an empty one.
  Ref(const Found<T>& found);
  Ref(const Ref& other) noexcept : life_(other.life_), object_(other.object_) {
    if (life_) ++life_->references;
  }
  Ref(Ref&& other) noexcept
      : life_(std::exchange(other.life_, nullptr)), object_(std::exchange(other.object_, nullptr)) {}
  Ref& operator=(const Ref& other) {
    if (this == &other) return *this;
    if (other.life_) ++other.life_->references;
    release();
    life_ = other.life_;
    object_ = other.object_;
    return *this;
  }
  ~Ref() { release(); }

  /// The object; nullptr if the reference is empty.
  T* get() const { return life_ && life_->leaf ? object_ : nullptr; }
  /// The object. Precondition: not empty.
  T* operator->() const { return SPARK_ASSERT(get()), get(); }
  /// The object. Precondition: not empty.
  T& operator*() const { return SPARK_ASSERT(get()), *get(); }
  /// True if the reference is not empty.
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
