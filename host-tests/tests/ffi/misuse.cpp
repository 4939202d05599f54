// The same program in C++.
#include "misuse.c"
