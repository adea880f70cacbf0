#pragma once
/// \file
/// Counts the heap allocations of a test program. Exactly one file of the program includes it: it replaces the global
/// operator new. Not for builds with a sanitizer, which replaces operator new itself.

#include <dlfcn.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string_view>

namespace spark::test {

/// Counts the allocations of all threads of the process while `on`. ODE's own allocations are not counted: its hash
/// spaces allocate in every step.
struct Allocations {
  static inline std::atomic<bool> on = false;
  static inline std::atomic<int> count = 0;

  /// The number of allocations during `run`.
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
