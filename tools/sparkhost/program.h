#pragma once
/// \file
/// sparkhost as a function, and the same under the name and with the options of the installed base's server.

namespace sparkhost {

/// What the program sparkhost does with this command line; returns its exit code. To be called once, from main().
int runProgram(int argc, char** argv);
/// The same for rcssserver3d and simspark.
int runServer3d(int argc, char** argv);

}  // namespace sparkhost
