#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#if defined(__SANITIZE_THREAD__)
/// ODE is not instrumented: a block that one thread's world leaves to another's through ODE's own atomics (it keeps the
/// pose of the last geom that went) looks like a race.
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions() {
  return "race:libode.so\n";
}
#endif
