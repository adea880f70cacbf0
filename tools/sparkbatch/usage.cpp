#include "usage.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace sparkbatch {

namespace {
/// The value of a line "key:  123 kB" of /proc/self/status in MB.
double megabytes(const std::string& key) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) * 1024e-6;
  return 0;
}
}  // namespace

Usage::Usage(int threads) : threads_(threads), before_(megabytes("VmRSS")) {}

void Usage::measure() {
  peak_ = megabytes("VmHWM");
  perWorld_ = std::max(0.0, peak_ - before_) / threads_;
}

Json Usage::json() const { return {{"threads", threads_}, {"peak", peak_}, {"perWorld", perWorld_}}; }

void Usage::add(const Json& other) {
  threads_ += other["threads"].get<int>();
  peak_ = std::max(peak_, other["peak"].get<double>());
  perWorld_ = std::max(perWorld_, other["perWorld"].get<double>());
}

}  // namespace sparkbatch
