#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#if defined(__SANITIZE_THREAD__)
/// ODE is not instrumented. It keeps the pose block of the last destroyed geom and hands it to the next world, also of
/// another thread, by its own atomics. To the thread sanitizer this looks like a race. So does what Mesa's driver does
/// in its own threads, which wait for each other by futexes.
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions() {
  return "race:libode.so\nrace:swrast_dri.so\n";
}
#endif
