#include "spark/assert.h"

#include <cstdio>
#include <cstdlib>

namespace spark {

void detail::assertionFailed(const char* condition, const char* file, int line) {
  // The same form as a compiler's message, so that editors find the place.
  std::fprintf(stderr, "%s:%d: the precondition does not hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace spark
