#pragma once
/// \file
/// sparkhost as a function, for programs that are sparkhost under another name.

namespace sparkhost {

/// What the program sparkhost does with this command line; returns its exit code. To be called once, from main().
int runProgram(int argc, char** argv);

}  // namespace sparkhost
