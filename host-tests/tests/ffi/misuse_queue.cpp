// The same program in C++.
#include "misuse_queue.c"
