#pragma once
/// \file
/// Reports of crashes.

namespace sparkhost {

/// Installs signal handlers: a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) of any thread is reported on stderr
/// before it ends the process in the usual way. The report names `program` (a literal), the signal, and the code that
/// the thread was running. Call it once, at the start of main().
void installCrashReport(const char* program);

}  // namespace sparkhost
