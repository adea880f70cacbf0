#pragma once
/// \file
/// Reports of crashes.

namespace sparkhost {

/// From here on a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) of any thread is reported on stderr before it ends
/// the process as it would have: `program` (a literal), the signal, and what the thread ran. Call it once, at the start
/// of main().
void installCrashReport(const char* program);

}  // namespace sparkhost
