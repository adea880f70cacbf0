#pragma once
/// \file
/// What a plugin exports: one C descriptor. A plugin does nothing at load; registering is an explicit call by the host.
///
///     SPARK_PLUGIN("sensors", "1.0", "Perceptors of robots.", GyroRatePerceptor, Accelerometer)

#include <array>
#include <cstddef>
#include <cstdint>

#include "spark/abi.h"
#include "spark/abi/spark/plugin.h"
#include "spark/describe.h"

namespace spark {

/// The list of the public headers that this library was compiled with, which the linker joins from its object files:
/// "api/physics.h 0123456789abcdef" each, with the hash of the header's text without comments, and zeros between them.
extern "C" {
[[gnu::visibility("hidden")]] extern const char __start_spark_headers[];
[[gnu::visibility("hidden")]] extern const char __stop_spark_headers[];
}

/// What must agree between a plugin and its host, beside the headers. Debug and Release mix.
struct AbiWord {
  std::uint32_t version;    ///< SPARK_ABI_VERSION, raised when the descriptor changes
  std::uint32_t alignment;  ///< alignof(max_align_t)
  std::uint32_t compiler;   ///< __GXX_ABI_VERSION
  std::uint32_t sanitizer;  ///< 0 none, 1 address, 2 thread
};

/// The AbiWord of the code that includes this header.
constexpr AbiWord thisAbi() {
  AbiWord w{SPARK_ABI_VERSION, alignof(std::max_align_t), __GXX_ABI_VERSION, 0};
#if defined(__SANITIZE_ADDRESS__)
  w.sanitizer = 1;
#elif defined(__SANITIZE_THREAD__)
  w.sanitizer = 2;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
  w.sanitizer = 1;
#elif __has_feature(thread_sanitizer)
  w.sanitizer = 2;
#endif
#endif
  return w;
}

/// Takes a plugin's classes.
class Registrar {
 public:
  virtual void add(ClassDescription description) = 0;
  /// Runs when the plugin is unloaded, before its classes go.
  virtual void atUnload(std::function<void()> action) = 0;

 protected:
  ~Registrar() = default;
};

/// The descriptor, exported as `sparkPlugin`. Its first two members never move.
struct PluginDescriptor {
  char magic[8];       ///< "SPARKPLG"
  std::uint32_t size;  ///< sizeof(PluginDescriptor) of the plugin
  AbiWord abi;
  const char* headers;  ///< __start_spark_headers: of the headers that the plugin includes, and of no others
  const char* headersEnd;
  const char* name;
  const char* version;
  const char* doc;
  const char* const* classes;  ///< names, ended by nullptr
  void (*registerClasses)(Registrar&);
};

namespace detail {
template <class... T>
struct ClassList {
  static constexpr std::array<const char*, sizeof...(T) + 1> kNames{T::kClassName..., nullptr};
  static void registerAll(Registrar& registrar) { (registrar.add(describeClass<T>()), ...); }
};
}  // namespace detail

/// Defines the descriptor. The rest of the arguments are the plugin's classes.
#define SPARK_PLUGIN(Name, Version, Doc, ...)                                                            \
  extern "C" __attribute__((visibility("default")))                                                      \
  const ::spark::PluginDescriptor sparkPlugin = {{'S', 'P', 'A', 'R', 'K', 'P', 'L', 'G'},               \
                                                 sizeof(::spark::PluginDescriptor),                      \
                                                 ::spark::thisAbi(),                                     \
                                                 ::spark::__start_spark_headers,                         \
                                                 ::spark::__stop_spark_headers,                          \
                                                 Name,                                                   \
                                                 Version,                                                \
                                                 Doc,                                                    \
                                                 ::spark::detail::ClassList<__VA_ARGS__>::kNames.data(), \
                                                 &::spark::detail::ClassList<__VA_ARGS__>::registerAll};

}  // namespace spark
