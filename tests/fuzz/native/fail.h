#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

/// Ends the process, which is how libFuzzer sees that a promise was broken.
[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}
