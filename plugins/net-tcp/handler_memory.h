#pragma once
/// \file
/// Reusable memory for the one outstanding wait of a socket: waiting for input allocates nothing in steady state.

#include <cstddef>
#include <new>
#include <utility>

namespace spark::net {

/// A block of memory for one handler at a time. A larger handler, or a second one, gets memory from the heap.
class HandlerMemory {
 public:
  HandlerMemory() = default;
  HandlerMemory(const HandlerMemory&) = delete;
  HandlerMemory& operator=(const HandlerMemory&) = delete;

  void* allocate(std::size_t size) {
    if (used_ || size > sizeof(block_)) return ::operator new(size);
    used_ = true;
    return block_;
  }
  void deallocate(void* p) {
    if (p == block_)
      used_ = false;
    else
      ::operator delete(p);
  }

 private:
  alignas(std::max_align_t) unsigned char block_[512];
  bool used_ = false;
};

/// The allocator that Asio gets from a handler. The memory must outlive the handler.
template <class T>
struct HandlerAllocator {
  using value_type = T;
  explicit HandlerAllocator(HandlerMemory& m) : memory(&m) {}
  template <class U>
  HandlerAllocator(const HandlerAllocator<U>& other) : memory(other.memory) {}
  T* allocate(std::size_t n) const { return static_cast<T*>(memory->allocate(n * sizeof(T))); }
  void deallocate(T* p, std::size_t) const { memory->deallocate(p); }
  template <class U>
  bool operator==(const HandlerAllocator<U>& other) const {
    return memory == other.memory;
  }
  HandlerMemory* memory;
};

/// A completion handler that Asio places into `memory`; calls `f` with Asio's arguments.
template <class F>
class MemoryHandler {
 public:
  using allocator_type = HandlerAllocator<F>;
  MemoryHandler(HandlerMemory& memory, F f) : memory_(&memory), f_(std::move(f)) {}
  allocator_type get_allocator() const noexcept { return allocator_type(*memory_); }
  template <class... A>
  void operator()(A&&... a) {
    f_(std::forward<A>(a)...);
  }

 private:
  HandlerMemory* memory_;
  F f_;
};

}  // namespace spark::net
