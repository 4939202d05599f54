// The same program in C++.
#include "misuse_motion.c"
