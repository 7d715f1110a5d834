# Benchmarks, each where its libraries are installed; built by the targets `benchmarks` and `comparison`, run by scripts/benchmark and
# scripts/compare_engines.
if(NOT BLEM_SIM_TESTS)
  return()
endif()

find_package(benchmark QUIET)
if(benchmark_FOUND)
  add_long_run(solver_benchmark ${PROJECT_SOURCE_DIR}/benchmark/solver_benchmark.cpp ${PROJECT_SOURCE_DIR}/test/soak/hubo_stand.cpp)
  add_long_run(contact_benchmark ${PROJECT_SOURCE_DIR}/benchmark/contact_benchmark.cpp ${PROJECT_SOURCE_DIR}/benchmark/contact_scenes.cpp
    ${PROJECT_SOURCE_DIR}/benchmark/plain_tree.cpp)
  add_long_run(load_benchmark ${PROJECT_SOURCE_DIR}/benchmark/load_benchmark.cpp)
  target_link_libraries(solver_benchmark benchmark::benchmark)
  target_link_libraries(contact_benchmark benchmark::benchmark)
  target_link_libraries(load_benchmark benchmark::benchmark PkgConfig::TBB)
  add_custom_target(benchmarks DEPENDS solver_benchmark contact_benchmark load_benchmark)
endif()

# The peers of the comparison, as Debian packages them.
find_package(PkgConfig QUIET)
pkg_check_modules(BULLET QUIET IMPORTED_TARGET bullet)
if(BULLET_FOUND)
  file(GLOB comparison_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmark/comparison/*.cpp)
  add_executable(comparison EXCLUDE_FROM_ALL ${comparison_sources})
  target_link_libraries(comparison blem_sim_sim PkgConfig::BULLET PkgConfig::ODE)
  set_target_properties(comparison PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
endif()
