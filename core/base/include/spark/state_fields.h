#pragma once
/// \file
/// State as one list of members, which is saved and loaded by the same line: none can be forgotten in one of the two.
///
///     class Walk {
///       template <class F>
///       void fields(F& f) { f(phase_, strength_, from_); }
///     };
///     void Walker::saveState(StateWriter& out) const { saveFields(out, walk_); }
///     void Walker::loadState(StateReader& in) { loadFields(in, walk_); }

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "spark/abi/spark/state_fields.h"
#include "spark/error.h"
#include "spark/state_stream.h"

namespace spark {

namespace detail {
template <class T, class F>
concept HasFields = requires(T& v, F& f) {
  v.fields(f);
};
/// A vector or matrix of Eigen.
template <class T>
concept FixedMatrix = requires(T& v) {
  requires(T::SizeAtCompileTime > 0);
  v.data();
};
template <class T>
concept Range = requires(T& v) {
  v.begin();
  v.end();
};
template <class T>
concept Resizable = requires(T& v) {
  v.resize(1);
};
template <class T>
concept Map = requires {
  typename T::mapped_type;
};
}  // namespace detail

/// Writes members: numbers, enumerations, texts, values, optional ones, arrays, vectors, maps, Eigen's vectors and
/// matrices of fixed size, and structs with fields().
class FieldWriter {
 public:
  explicit FieldWriter(StateWriter& out) : out_(out) {}
  template <class... T>
  void operator()(const T&... members) {
    (one(members), ...);
  }

 private:
  template <class T>
  void one(const T& v) {
    if constexpr (detail::HasFields<T, FieldWriter>)
      const_cast<T&>(v).fields(*this);  // one function for both directions: here it only reads
    else if constexpr (std::is_enum_v<T> || std::is_integral_v<T>)
      out_.write(static_cast<std::int64_t>(v));
    else if constexpr (std::is_floating_point_v<T>)
      out_.write(static_cast<double>(v));
    else if constexpr (std::is_same_v<T, std::string>)
      out_.write(std::string_view(v));
    else if constexpr (std::is_same_v<T, Value>)
      out_.write(v);
    else if constexpr (detail::FixedMatrix<T>)
      for (std::ptrdiff_t i = 0; i < v.size(); ++i) out_.write(static_cast<double>(v.data()[i]));
    else if constexpr (detail::Range<T>)
      range(v);
    else
      optional(v);
  }
  template <class T>
  void range(const T& v) {
    if constexpr (detail::Resizable<T> || detail::Map<T>) out_.write(static_cast<std::int64_t>(v.size()));
    if constexpr (detail::Map<T>)
      for (const auto& [key, e] : v) one(key), one(e);
    else
      for (const auto& e : v) one(e);
  }
  template <class T>
  void optional(const std::optional<T>& v) {
    out_.write(v.has_value());
    if (v) one(*v);
  }
  StateWriter& out_;
};

/// Reads what a FieldWriter wrote. Throws Error where it does not fit.
class FieldReader {
 public:
  explicit FieldReader(StateReader& in) : in_(in) {}
  template <class... T>
  void operator()(T&... members) {
    (one(members), ...);
  }

 private:
  template <class T>
  void one(T& v) {
    if constexpr (detail::HasFields<T, FieldReader>)
      v.fields(*this);
    else if constexpr (std::is_enum_v<T> || std::is_integral_v<T>)
      v = static_cast<T>(in_.readInteger());
    else if constexpr (std::is_floating_point_v<T>)
      v = static_cast<T>(in_.readNumber());
    else if constexpr (std::is_same_v<T, std::string>)
      v = in_.readString();
    else if constexpr (std::is_same_v<T, Value>)
      v = in_.readValue();
    else if constexpr (detail::Map<T>)
      map(v);
    else if constexpr (detail::FixedMatrix<T>)
      for (std::ptrdiff_t i = 0; i < v.size(); ++i) v.data()[i] = in_.readNumber();
    else if constexpr (detail::Range<T>)
      range(v);
    else
      optional(v);
  }
  template <class T>
  void range(T& v) {
    if constexpr (detail::Resizable<T>) v.resize(in_.readCount());
    for (auto& e : v) one(e);
  }
  template <class T>
  void map(T& v) {
    v.clear();
    for (std::size_t n = in_.readCount(); n > 0; --n) {
      typename T::key_type key{};
      one(key);
      one(v[std::move(key)]);
    }
  }
  template <class T>
  void optional(std::optional<T>& v) {
    v.reset();
    if (in_.readBool()) one(v.emplace());
  }
  StateReader& in_;
};

/// Writes the fields of an object.
template <class T>
void saveFields(StateWriter& out, const T& object) {
  FieldWriter{out}(object);
}
/// Reads them again. Throws Error where they do not fit.
template <class T>
void loadFields(StateReader& in, T& object) {
  FieldReader{in}(object);
}

}  // namespace spark
