// Leaks that the leak sanitizer passes over in test_model; no test of its own.

/** assimp keeps the content read from a file that it then refuses, PCL's Poisson a table of 16 kB for each surface. @return suppressions in
 * LeakSanitizer's format */
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\nleak:libpcl_surface\n"; }
