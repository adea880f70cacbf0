#include "pace.h"

#include <fmt/format.h>

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
    out.push_back(List{Value(name), Value(h.count()), Value(h.percentile(0.5)), Value(h.percentile(0.9)),
                       Value(h.percentile(0.99)), Value(h.percentile(0.999)), Value(h.longest())});
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
      out.push_back(List{Value(Histogram::begin(i)), Value(late_.inBucket(i)), Value(long_.inBucket(i)),
                         Value(done_.inBucket(i))});
  return out;
}

std::string Pace::table() const {
  std::string out = fmt::format("{:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "[us]", "cycles", "50 %", "90 %",
                                "99 %", "99.9 %", "longest");
  for (const Value& row : percentiles()) {
    const List& r = row.toList();
    out += fmt::format("{:>10} {:>9}", r[0].toString(), r[1].toInteger());
    for (std::size_t i = 2; i < r.size(); ++i) out += fmt::format(" {:>9.0f}", r[i].toNumber());
    out += '\n';
  }

  // Rows of 8 buckets each.
  out += fmt::format("{:>10} {:>9} {:>9} {:>9}\n", "from [us]", "late", "long", "done");
  constexpr std::size_t kRow = 8;
  const auto sum = [](const Histogram& h, std::size_t from) {
    std::int64_t n = 0;
    for (std::size_t i = from; i < from + kRow; ++i) n += h.inBucket(i);
    return n;
  };
  for (std::size_t i = 0; i < Histogram::kBuckets; i += kRow) {
    const std::int64_t late = sum(late_, i), length = sum(long_, i), done = sum(done_, i);
    if (late || length || done)
      out += fmt::format("{:>10.0f} {:>9} {:>9} {:>9}\n", Histogram::begin(i), late, length, done);
  }
  return out;
}

}  // namespace spark::simulation
