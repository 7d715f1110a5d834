// Leaks that LeakSanitizer need not report of test_sim.

/** A step that ODE ends with an error leaves its threading's wait object behind. @return suppressions in LeakSanitizer's format */
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:dxtemplateThreadingImplementation\n"; }
