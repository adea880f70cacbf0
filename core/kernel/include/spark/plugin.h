#pragma once
/// \file
/// The descriptor that a plugin exports. A plugin runs no code when it is loaded; the host registers it by a call.
///
///     SPARK_PLUGIN("sensors", "1.0", "Perceptors of robots.", GyroRatePerceptor, Accelerometer)

#include <array>
#include <cstddef>
#include <cstdint>

#include "spark/abi.h"
#include "spark/abi/spark/plugin.h"
#include "spark/describe.h"

namespace spark {

extern "C" {
// The linker defines these names for the section spark_headers, so they cannot be others.
/// The public headers that this library was compiled with: texts such as "api/physics.h 0123456789abcdef", with the
/// hash of the header without comments, separated by zeros. The linker joins the lists of all object files.
[[gnu::visibility("hidden")]] extern const char __start_spark_headers[];  // NOLINT(bugprone-reserved-identifier)
/// The end of that list.
[[gnu::visibility("hidden")]] extern const char __stop_spark_headers[];  // NOLINT(bugprone-reserved-identifier)
}

/// What must be equal in a plugin and its host, beside the headers. Debug and Release builds agree.
struct AbiWord {
  std::uint32_t version;    ///< SPARK_ABI_VERSION, raised when the descriptor changes
  std::uint32_t alignment;  ///< alignof(max_align_t)
  std::uint32_t compiler;   ///< __GXX_ABI_VERSION
  std::uint32_t sanitizer;  ///< 0 none, 1 address, 2 thread
};

/// The AbiWord of the code that is compiled with this header.
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

/// Receives the classes of a plugin.
class Registrar {
 public:
  /// Adds a class.
  virtual void add(ClassDescription description) = 0;
  /// Adds an action that runs when the plugin is unloaded, before its classes are removed.
  virtual void atUnload(std::function<void()> action) = 0;

 protected:
  ~Registrar() = default;
};

/// The descriptor, exported as `sparkPlugin`. The first two members are the same in every version.
struct PluginDescriptor {
  char magic[8];        ///< "SPARKPLG"
  std::uint32_t size;   ///< sizeof(PluginDescriptor) when the plugin was compiled
  AbiWord abi;          ///< of the plugin
  const char* headers;  ///< __start_spark_headers: the headers that the plugin includes
  const char* headersEnd;
  const char* name;                     ///< of the plugin: letters, digits, '-', '_' and '.'
  const char* version;                  ///< of the plugin, any text
  const char* doc;                      ///< one sentence
  const char* const* classes;           ///< names of its classes, ended by nullptr
  void (*registerClasses)(Registrar&);  ///< passes the descriptions of all its classes
};

namespace detail {
template <class... T>
struct ClassList {
  static constexpr std::array<const char*, sizeof...(T) + 1> kNames{T::kClassName..., nullptr};
  static void registerAll(Registrar& registrar) { (registrar.add(describeClass<T>()), ...); }
};
}  // namespace detail

/// Defines the descriptor of a plugin. The arguments behind `Doc` are its classes.
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
