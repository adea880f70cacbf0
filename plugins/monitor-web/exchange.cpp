#include "exchange.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "spark/error.h"

namespace spark::web {

Exchange::Exchange() : descriptor_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (descriptor_ < 0) throw Error(std::string("cannot make an eventfd: ") + std::strerror(errno));
}

Exchange::~Exchange() { close(descriptor_); }

void Exchange::wake() {
  const std::uint64_t one = 1;
  // It cannot fail but for a full counter, which wakes as well.
  [[maybe_unused]] const auto written = write(descriptor_, &one, sizeof one);
}

}  // namespace spark::web
