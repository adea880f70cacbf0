#pragma once
/// \file
/// Counts what a test program takes from the heap. One file of a program includes it: it replaces operator new for all.
/// Not for programs with a sanitizer, which has an operator new of its own.

#include <dlfcn.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string_view>

namespace spark::test {

/// What all threads of the process take from the heap while `on`. Not counted: what ODE takes itself; its hash spaces
/// do in every step.
struct Allocations {
  static inline std::atomic<bool> on = false;
  static inline std::atomic<int> count = 0;

  /// How often `run` takes something.
  template <class F>
  static int in(F run) {
    count = 0;
    on = true;
    run();
    on = false;
    return count;
  }
  static void* take(std::size_t size, std::size_t alignment, const void* caller) {
    if (on && !isOde(caller)) ++count;
    if (size == 0) size = 1;
    void* p = alignment == 0 ? std::malloc(size)
                             : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    return p ? p : throw std::bad_alloc();
  }

 private:
  static bool isOde(const void* caller) {
    Dl_info library;
    return dladdr(caller, &library) && std::string_view(library.dli_fname).find("libode.") != std::string_view::npos;
  }
};

}  // namespace spark::test

void* operator new(std::size_t size) { return spark::test::Allocations::take(size, 0, __builtin_return_address(0)); }
void* operator new[](std::size_t size) { return spark::test::Allocations::take(size, 0, __builtin_return_address(0)); }
void* operator new(std::size_t size, std::align_val_t a) {
  return spark::test::Allocations::take(size, static_cast<std::size_t>(a), __builtin_return_address(0));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return spark::test::Allocations::take(size, static_cast<std::size_t>(a), __builtin_return_address(0));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
