#include "gamecontrol/transit_queue.h"

#include <catch2/catch.hpp>
#include <vector>

#include "spark/state.h"

using namespace spark;
using gamecontrol::TransitQueue;

namespace {
void put(TransitQueue& queue, std::int64_t due, int message) { queue.add(due).open("m").add(message).close(); }

int messageOf(const Predicates& p) { return static_cast<int>((*p.begin()).at(1).integer()); }

/// The messages that arrive in a cycle.
std::vector<int> take(TransitQueue& queue, std::int64_t cycle) {
  std::vector<int> out;
  for (; queue.hasArrived(cycle); queue.pop()) out.push_back(messageOf(queue.first()));
  return out;
}
using Numbers = std::vector<int>;
}  // namespace

TEST_CASE("A message arrives in the cycle in which it is due, and not before") {
  TransitQueue queue;
  CHECK_FALSE(queue.hasArrived(1000));
  put(queue, 5, 1);
  put(queue, 7, 2);
  CHECK(take(queue, 4) == Numbers{});
  CHECK(take(queue, 5) == Numbers{1});
  CHECK(take(queue, 6) == Numbers{});
  CHECK(queue.size() == 1);
  CHECK(take(queue, 8) == Numbers{2});
  CHECK(queue.size() == 0);
}

TEST_CASE("No message overtakes an earlier one") {
  TransitQueue queue;
  put(queue, 9, 1);
  put(queue, 3, 2);
  CHECK(take(queue, 8) == Numbers{});
  CHECK(take(queue, 9) == Numbers{1, 2});
  put(queue, 4, 3);  // the earlier ones have arrived
  CHECK(take(queue, 4) == Numbers{3});
}

TEST_CASE("The message that was added last can be read until the next one is added") {
  TransitQueue queue;
  CHECK(queue.newest().empty());
  put(queue, 1, 1);
  put(queue, 2, 2);
  CHECK(messageOf(queue.newest()) == 2);
  CHECK(queue.lastDue() == 2);
  take(queue, 2);
  CHECK(messageOf(queue.newest()) == 2);
  CHECK(queue.add(3).empty());
  CHECK(queue.newest().empty());
}

TEST_CASE("A queue grows in every position of its ring") {
  for (int lead = 0; lead < 5; ++lead) {
    TransitQueue queue;
    int in = 0, out = 0;
    const auto pop = [&] {
      CHECK(messageOf(queue.first()) == ++out);
      queue.pop();
    };
    for (int i = 0; i < 4; ++i) put(queue, 0, ++in);
    for (int i = 0; i < lead % 4; ++i) pop(), put(queue, 0, ++in);
    for (int i = 0; i < 7; ++i) put(queue, 0, ++in);
    CHECK(queue.tokens() == 3 * queue.size());
    while (queue.size() > 0) pop();
    CHECK(out == in);
  }
}

TEST_CASE("What is under way is saved with the time when it is due") {
  TransitQueue queue;
  put(queue, 1, 1);
  put(queue, 5, 2);
  put(queue, 6, 3);
  queue.pop();
  StateWriter out(true);
  queue.save(out, queue.size());
  StateReader in(out.bytes());
  TransitQueue restored;
  restored.load(in, 2);
  CHECK(in.atEnd());
  CHECK(take(restored, 4) == Numbers{});
  CHECK(take(restored, 5) == Numbers{2});
  CHECK(take(restored, 6) == Numbers{3});
}
