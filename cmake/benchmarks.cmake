# The solver's benchmark, where Google Benchmark is installed; built by the target `benchmarks`, run by scripts/benchmark.
find_package(benchmark QUIET)
if(NOT benchmark_FOUND OR NOT BLEM_SIM_TESTS)
  return()
endif()
add_executable(solver_benchmark EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/benchmark/solver_benchmark.cpp
  ${PROJECT_SOURCE_DIR}/test/soak/hubo_stand.cpp)
target_include_directories(solver_benchmark PRIVATE ${PROJECT_SOURCE_DIR}/test ${PROJECT_SOURCE_DIR}/src/sim)
target_link_libraries(solver_benchmark blem_sim_sim GTest::gtest Threads::Threads benchmark::benchmark)
target_compile_definitions(solver_benchmark PRIVATE BLEM_SIM_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(solver_benchmark PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
add_custom_target(benchmarks DEPENDS solver_benchmark)
