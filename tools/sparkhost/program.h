#pragma once
/// \file
/// The programs sparkhost and rcssserver3d as functions.

namespace sparkhost {

/// Runs sparkhost with this command line and returns the exit code. Call it once, from main().
int runProgram(int argc, char** argv);
/// The same with the command line of rcssserver3d and simspark.
int runServer3d(int argc, char** argv);

}  // namespace sparkhost
