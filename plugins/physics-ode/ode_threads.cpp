#include "ode_threads.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "ode_process.h"

namespace spark::ode {

thread_local IslandThreads::Lane* IslandThreads::current = nullptr;

void IslandThreads::attachTo(dWorldID world) {
  dWorldSetStepThreadingImplementation(world, &functions(), reinterpret_cast<dThreadingImplementationID>(this));
}

void IslandThreads::takeMessage(std::string& text) {
  for (Lane& lane : lanes_) {
    if (!lane.message.empty()) text = lane.message;
    lane.message.clear();
  }
}

void IslandThreads::Lane::grow(std::size_t calls) {
  while (memory.size() < calls) free.push_back(&memory.emplace_back());
  // Each call is in one of them.
  free.reserve(memory.size());
  posted.reserve(memory.size());
}

std::string IslandThreads::takeFailure() {
  std::string text = std::exchange(outside_.failure, {});
  for (Lane& lane : lanes_)
    if (!lane.failure.empty()) text = std::exchange(lane.failure, {});
  if (text.empty()) return text;
  for (Lane& lane : lanes_) lane.abandon();
  outside_.abandon();
  failed_ = false;
  return text;
}

void IslandThreads::Lane::abandon() {
  posted.clear();
  free.clear();
  for (Call& call : memory) free.push_back(&call);
}

IslandThreads::Call& IslandThreads::post(Call* dependent, int* fault, std::size_t dependencies,
                                         dThreadedCallFunction* function, void* context, dcallindex_t index) {
  Lane& lane = current ? *current : outside_;
  if (lane.free.empty()) lane.grow(lane.memory.size() + 1);
  Call& call = *lane.free.back();
  lane.free.pop_back();
  call.owner = &lane;
  call.function = function;
  call.context = context;
  call.index = index;
  call.dependent = dependent;
  call.fault = fault;
  call.dependencies = static_cast<std::ptrdiff_t>(dependencies);
  call.started = false;
  lane.posted.push_back(&call);
  return call;
}

void IslandThreads::runAll() {
  if (parallel_) runJobStarts();
  runPosted(outside_);
}

void IslandThreads::runJobStarts() {
  // The posted calls without dependencies are the job starts.
  starts_.clear();
  for (Call* call : outside_.posted)
    if (call->dependencies == 0) starts_.push_back(call);
  std::erase_if(outside_.posted, [](const Call* call) { return call->dependencies == 0; });

  // Each job runs one start and the calls that it posts.
  // Timing decides which thread solves which island: so that this decides nothing about memory, all lanes have as much
  // as the largest one.
  while (lanes_.size() < starts_.size()) lanes_.emplace_back();
  std::size_t largest = 0;
  for (const Lane& lane : lanes_) largest = std::max(largest, lane.memory.size());
  for (Lane& lane : lanes_) lane.grow(largest);
  jobs_.run(starts_.size(), [this](std::size_t i) {
    Lane& lane = lanes_[i];
    const MessageCapture capture(lane.message, strict_);
    current = &lane;
    run(lane, *starts_[i]);
    runPosted(lane);
    current = nullptr;
  });
  // The memory of a call goes back to the lane that posted it.
  outside_.free.insert(outside_.free.end(), starts_.begin(), starts_.end());
}

void IslandThreads::runPosted(Lane& lane) {
  while (true) {
    auto call = lane.posted.end();
    do {
      if (call == lane.posted.begin()) return;
      --call;
    } while ((*call)->dependencies != 0);
    Call& ready = **call;
    lane.posted.erase(call);
    run(lane, ready);
  }
}

void IslandThreads::run(Lane& lane, Call& call) {
  // While it runs, the call depends on itself; it may add further calls as dependencies.
  call.started = true;
  call.dependencies = 1;
  try {
    if (!call.function(call.context, call.index, reinterpret_cast<dCallReleaseeID>(&call))) failed_ = true;
  } catch (const Failure& failure) {
    lane.failure = failure.what();
    failed_ = true;
  }
  finishDependency(lane, &call);
}

void IslandThreads::finishDependency(Lane& lane, Call* call) {
  while (call && call->dependencies.fetch_sub(1) == 1 && call->started) {
    if (call->fault) *call->fault = failed_.exchange(false);
    Call* const dependent = call->dependent;
    if (call->owner == &lane) lane.free.push_back(call);
    call = dependent;
  }
}

const dThreadingFunctionsInfo& IslandThreads::functions() {
  using Id = dThreadingImplementationID;
  static const auto mutexes = [](dMutexGroupID group) { return reinterpret_cast<std::mutex*>(group); };
  static const dThreadingFunctionsInfo info{
      sizeof(dThreadingFunctionsInfo),
      [](Id, dmutexindex_t n, const char* const*) { return reinterpret_cast<dMutexGroupID>(new std::mutex[n]); },
      [](Id, dMutexGroupID group) { delete[] mutexes(group); },
      [](Id id, dMutexGroupID group, dmutexindex_t i) {
        if (of(id).parallel_) mutexes(group)[i].lock();
      },
      [](Id id, dMutexGroupID group, dmutexindex_t i) {
        if (of(id).parallel_) mutexes(group)[i].unlock();
      },
      // A world waits for one call at a time, and the waiting thread runs it: wait objects need no state.
      [](Id id) { return reinterpret_cast<dCallWaitID>(id); },
      [](Id, dCallWaitID) {},
      [](Id, dCallWaitID) {},
      [](Id id, int* fault, dCallReleaseeID* out, ddependencycount_t dependencies, dCallReleaseeID dependent,
         dCallWaitID, dThreadedCallFunction* function, void* context, dcallindex_t index, const char*) {
        Call& call = of(id).post(reinterpret_cast<Call*>(dependent), fault, dependencies, function, context, index);
        if (out) *out = reinterpret_cast<dCallReleaseeID>(&call);
      },
      [](Id, dCallReleaseeID call, ddependencychange_t change) {
        reinterpret_cast<Call*>(call)->dependencies += change;
      },
      [](Id id, int* done, dCallWaitID, const dThreadedWaitTime*, const char*) {
        of(id).runAll();
        if (done) *done = 1;
      },
      [](Id id) { return of(id).threads(); },
      [](Id, ddependencycount_t) { return 1; },
  };
  return info;
}

}  // namespace spark::ode
