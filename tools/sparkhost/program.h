#pragma once
/// \file
/// The programs sparkhost and rcssserver3d as functions.

#include <string>

namespace spark {
class Kernel;
}

namespace sparkhost {

/// Runs sparkhost with this command line and returns the exit code. Call it once, from main().
int runProgram(int argc, char** argv);
/// The same with the command line of rcssserver3d and simspark.
int runServer3d(int argc, char** argv);

/// The first SIGINT, SIGTERM or SIGHUP stops the run, a second one kills the process. SIGHUP stays ignored under nohup.
void watchSignals(spark::Kernel& kernel);
/// Throws Error if a file that is written is one that is read, or that is written too: "" is none.
void refuseSameFile(const std::string& written, const std::string& other, const char* what);

}  // namespace sparkhost
