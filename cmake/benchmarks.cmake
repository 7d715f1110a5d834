# Benchmarks, each where its libraries are installed; built by the targets `benchmarks` and `comparison`, run by scripts/benchmark and
# scripts/compare_engines.
if(NOT BLEM_SIM_TESTS)
  return()
endif()

find_package(benchmark QUIET)
if(benchmark_FOUND)
  set(benchmark ${PROJECT_SOURCE_DIR}/benchmark)
  add_long_run(solver_benchmark ${benchmark}/solver_benchmark.cpp ${PROJECT_SOURCE_DIR}/test/soak/hubo_stand.cpp)
  set(contact_generation ${benchmark}/contact_generation.cpp ${benchmark}/contact_scenes.cpp ${benchmark}/plain_tree.cpp)
  add_long_run(contact_benchmark ${benchmark}/contact_benchmark.cpp ${benchmark}/known_pairs.cpp ${contact_generation})
  # It runs the search's own kernels.
  target_include_directories(contact_benchmark PRIVATE ${PROJECT_SOURCE_DIR}/src/contact)
  add_long_run(reduction_benchmark ${benchmark}/reduction_benchmark.cpp)
  add_long_run(scene_benchmark ${benchmark}/scene_benchmark.cpp)
  add_long_run(load_benchmark ${benchmark}/load_benchmark.cpp)
  set(benchmarks solver_benchmark contact_benchmark reduction_benchmark scene_benchmark load_benchmark)
  foreach(each ${benchmarks})
    target_link_libraries(${each} benchmark::benchmark)
  endforeach()
  target_link_libraries(load_benchmark PkgConfig::TBB)
  add_custom_target(benchmarks DEPENDS ${benchmarks})
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
