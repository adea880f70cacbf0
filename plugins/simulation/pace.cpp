#include "pace.h"

namespace spark::simulation {

void Pace::begin(Clock::time_point due, Clock::time_point now, bool paced) {
  due_ = due;
  begun_ = now;
  paced_ = paced;
  if (paced) late_.add(now - due);
}

void Pace::end(Clock::time_point now) {
  long_.add(now - begun_);
  if (paced_) done_.add(now - due_);
}

void Pace::reset() {
  late_.reset();
  long_.reset();
  done_.reset();
}

List Pace::percentiles() const {
  List out;
  const auto put = [&out](const char* name, const Histogram& h) {
    out.push_back(List{Value(name), Value(h.count()), Value(h.percentile(0.5)), Value(h.percentile(0.9)), Value(h.percentile(0.99)), Value(h.percentile(0.999)), Value(h.longest())});
  };
  put("late", late_);
  put("long", long_);
  put("done", done_);
  return out;
}

List Pace::buckets() const {
  List out;
  for (std::size_t i = 0; i < Histogram::kBuckets; ++i)
    if (late_.inBucket(i) || long_.inBucket(i) || done_.inBucket(i))
      out.push_back(List{Value(Histogram::begin(i)), Value(late_.inBucket(i)), Value(long_.inBucket(i)), Value(done_.inBucket(i))});
  return out;
}

}  // namespace spark::simulation
