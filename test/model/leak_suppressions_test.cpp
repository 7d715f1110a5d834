// What the leak sanitizer is to pass over in test_model; no test of its own.

/** assimp keeps what it had read of a file that it then refuses. @return suppressions in LeakSanitizer's format */
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }
