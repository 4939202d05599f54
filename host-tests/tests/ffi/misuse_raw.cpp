// The same program in C++.
#include "misuse_raw.c"
