#include "ode_process.h"

#include <ode/ode.h>

#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

namespace spark::ode {
namespace {

std::mutex useMutex;
int users = 0;
std::atomic<std::uint64_t> generation = 0;
thread_local std::uint64_t threadGeneration = 0;
thread_local std::string* listener = nullptr;

void hear(int number, const char* format, va_list arguments) {
  if (!listener) return;
  char line[256];
  std::vsnprintf(line, sizeof line, format, arguments);
  *listener = std::string(line) + " (ODE message " + std::to_string(number) + ")";
}

}  // namespace

ProcessUse::ProcessUse() {
  const std::lock_guard lock(useMutex);
  if (users++ > 0) return;
  dInitODE2(0);
  ++generation;
  dSetErrorHandler(hear);
  dSetDebugHandler(hear);
  dSetMessageHandler(hear);
}

ProcessUse::~ProcessUse() {
  const std::lock_guard lock(useMutex);
  if (--users > 0) return;
  // The handlers are code of this plugin, which may be unmapped next.
  dSetErrorHandler(nullptr);
  dSetDebugHandler(nullptr);
  dSetMessageHandler(nullptr);
  dCloseODE();
}

Listening::Listening(std::string& text) : before_(listener) {
  listener = &text;
  if (threadGeneration == generation) return;
  const std::lock_guard lock(useMutex);
  dAllocateODEDataForThread(dAllocateMaskAll);
  threadGeneration = generation;
}

Listening::~Listening() { listener = before_; }

std::mutex& meshMutex() {
  static std::mutex mutex;
  return mutex;
}

std::mutex& quickMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace spark::ode
