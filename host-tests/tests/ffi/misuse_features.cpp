// The same program in C++.
#include "misuse_features.c"
