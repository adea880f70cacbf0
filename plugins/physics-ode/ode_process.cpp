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
thread_local bool lcpThrows = false;              // in this thread

std::string textOf(int number, const char* format, va_list arguments) {
  char line[256];
  std::vsnprintf(line, sizeof line, format, arguments);
  return fmt::format("{} (ODE message {})", line, number);
}

/// ODE's handler of warnings.
void onMessage(int number, const char* format, va_list arguments) {
  if (lcpThrows && number == d_ERR_LCP) throw Failure("ODE reports: " + textOf(number, format, arguments));
  if (receiver) *receiver = textOf(number, format, arguments);
}

/// ODE's handler of errors and assertions. ODE ends the process when it returns.
[[noreturn]] void onFailure(int number, const char* format, va_list arguments) {
  throw Failure("ODE failed: " + textOf(number, format, arguments));
}

}  // namespace

LibraryGuard::LibraryGuard() {
  const std::lock_guard lock(initMutex);
  if (guards++ > 0) return;
  dInitODE2(0);
  ++generation;
  dSetErrorHandler(onFailure);
  dSetDebugHandler(onFailure);
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

MessageCapture::MessageCapture(std::string& text, bool unsolvedThrows) : previous_(receiver), threw_(lcpThrows) {
  receiver = &text;
  lcpThrows = unsolvedThrows;
  if (threadGeneration == generation) return;
  const std::lock_guard lock(initMutex);
  dAllocateODEDataForThread(dAllocateMaskAll);
  threadGeneration = generation;
}

MessageCapture::~MessageCapture() {
  receiver = previous_;
  lcpThrows = threw_;
}

void Messages::report(const Leaf& node) {
  if (last.empty()) return;
  if (isDue()) node.kernel().log().warning("{}: ODE reports: {} (message {})", node.path(), last, count);
  last.clear();
}

void Messages::mend(const Leaf& node, const std::string& text) {
  if (isDue())
    node.kernel().log().warning("{}: {}. The island is solved approximately in this step (message {})", node.path(),
                                text, count);
}

void Messages::fail(const Leaf& node, const std::string& text, const std::string& what) {
  if (isDue()) node.kernel().log().error("{}: {}. {} (message {})", node.path(), text, what, count);
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
