#pragma once
/// \file
/// Private to the script server: a variable that has another value for a while.

#include <utility>

namespace spark::script {

/// Sets a variable. The destructor restores the value from before.
template <class T>
class Restore {
 public:
  template <class U>
  Restore(T& variable, U&& value) : variable_(variable), before_(variable) {
    variable = std::forward<U>(value);
  }
  ~Restore() { variable_ = before_; }
  Restore(const Restore&) = delete;
  Restore& operator=(const Restore&) = delete;

 private:
  T& variable_;
  T before_;
};
template <class T, class U>
Restore(T&, U&&) -> Restore<T>;

}  // namespace spark::script
