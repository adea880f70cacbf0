#pragma once
/// \file
/// The program's stdout, for its own lines alone.

#include <string>

namespace sparkhost {

/// From now on what libraries and plugins print to stdout goes to stderr. Call it once the command line is read, before
/// plugins are loaded; further calls have no effect.
void reserveStdout();
/// From now on a file that may not grow, and a pipe whose reader has gone, are errors of the write, which the writer
/// reports: by default they end the process (SIGXFSZ, SIGPIPE).
void survivePoorOutputs();
/// Prints text to stderr. What cannot be written is lost.
void printError(const std::string& text) noexcept;
/// Prints text to the stdout that the program was started with. False if it cannot be written: errno says why.
bool printOut(const std::string& text);

}  // namespace sparkhost
