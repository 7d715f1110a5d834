// Leaks of other people's libraries that the leak sanitizer passes over in the unit tests.

/** assimp keeps the content of a file that it then refuses; PCL's Poisson keeps a table of 16 kB for each surface; a step that ODE ends
 * with an error leaves the records of its threading behind. @return suppressions in LeakSanitizer's format */
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp\nleak:libpcl_surface\nleak:PreallocateJobInfos\nleak:dxtemplateThreadingImplementation\n";
}
