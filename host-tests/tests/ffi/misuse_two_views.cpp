// The same program in C++.
#include "misuse_two_views.c"
