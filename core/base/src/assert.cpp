#include "spark/assert.h"

#include <cstdio>
#include <cstdlib>

namespace spark {

void detail::assertionFailed(const char* condition, const char* file, int line) {
  // The format of a compiler message, so that editors can jump to the location.
  std::fprintf(stderr, "%s:%d: the precondition does not hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace spark
