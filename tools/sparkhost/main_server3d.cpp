#include "program.h"

int main(int argc, char** argv) { return sparkhost::runServer3d(argc, argv); }
