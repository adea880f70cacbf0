#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#if defined(__SANITIZE_THREAD__)
/// These libraries are not instrumented, so the thread sanitizer does not see how their threads wait for each other:
/// ODE keeps the pose block of the last destroyed geom and hands it to the next world, also of another thread, by its
/// own atomics; Mesa's driver has threads that wait by futexes; the threads of spdlog release the logger of each
/// message by the counter of a shared_ptr.
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions() {
  return "race:libode.so\nrace:swrast_dri.so\nrace:libspdlog.so\n";
}
#endif
