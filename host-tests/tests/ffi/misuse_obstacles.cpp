// The same program in C++.
#include "misuse_obstacles.c"
