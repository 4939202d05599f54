// The same program in C++.
#include "misuse_winners.c"
