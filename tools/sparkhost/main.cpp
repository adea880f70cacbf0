#include "program.h"

int main(int argc, char** argv) { return sparkhost::runProgram(argc, argv); }
