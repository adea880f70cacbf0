#include "ode_process.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

#include "spark/kernel.h"

namespace spark::ode {
namespace {

std::mutex initMutex;
int guards = 0;                                   // number of LibraryGuards
std::atomic<std::uint64_t> generation = 0;        // number of initialisations of ODE so far
thread_local std::uint64_t threadGeneration = 0;  // the one for which this thread's data was allocated
thread_local std::string* receiver = nullptr;     // of messages in this thread

/// ODE's message handler.
void onMessage(int number, const char* format, va_list arguments) {
  if (!receiver) return;
  char line[256];
  std::vsnprintf(line, sizeof line, format, arguments);
  *receiver = fmt::format("{} (ODE message {})", line, number);
}

}  // namespace

LibraryGuard::LibraryGuard() {
  const std::lock_guard lock(initMutex);
  if (guards++ > 0) return;
  dInitODE2(0);
  ++generation;
  dSetErrorHandler(onMessage);
  dSetDebugHandler(onMessage);
  dSetMessageHandler(onMessage);
}

LibraryGuard::~LibraryGuard() {
  const std::lock_guard lock(initMutex);
  if (--guards > 0) return;
  // The handlers are code of this plugin, which may be unloaded next.
  dSetErrorHandler(nullptr);
  dSetDebugHandler(nullptr);
  dSetMessageHandler(nullptr);
  dCloseODE();
}

MessageCapture::MessageCapture(std::string& text) : previous_(receiver) {
  receiver = &text;
  if (threadGeneration == generation) return;
  const std::lock_guard lock(initMutex);
  dAllocateODEDataForThread(dAllocateMaskAll);
  threadGeneration = generation;
}

MessageCapture::~MessageCapture() { receiver = previous_; }

void Messages::report(const Leaf& node) {
  if (last.empty()) return;
  ++count;
  if ((count & (count - 1)) == 0)
    node.kernel().log().warning("{}: ODE reports: {} (message {})", node.path(), last, count);
  last.clear();
}

std::mutex& meshMutex() {
  static std::mutex mutex;
  return mutex;
}

std::mutex& quickStepMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace spark::ode
