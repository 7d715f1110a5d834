# One library per room; links, like includes, only downwards (test/structure/arrows_test.py).
function(blem_sim_room room)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${room}/*.cpp)
  # Those for the instruction sets of one kind of machine are added below.
  list(FILTER sources EXCLUDE REGEX "_avx[^/]*\\.cpp$")
  add_library(blem_sim_${room} ${sources})
  target_include_directories(blem_sim_${room} PUBLIC ${PROJECT_SOURCE_DIR}/include PRIVATE ${PROJECT_SOURCE_DIR}/src/${room})
  target_link_libraries(blem_sim_${room} PUBLIC ${ARGN})
  # Loaders of files alone keep the checks of pointers.
  if(NOT room STREQUAL model)
    target_compile_options(blem_sim_${room} PRIVATE ${without_pointer_checks})
  endif()
  # No macro of a room's own: what is precompiled for one serves the others.
  set_target_properties(blem_sim_${room} PROPERTIES POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
endfunction()

blem_sim_room(geometry Eigen3::Eigen)
target_link_libraries(blem_sim_geometry PRIVATE PkgConfig::TBB)
blem_sim_precompile(blem_sim_geometry ${common_headers})
blem_sim_room(model blem_sim_geometry)
blem_sim_precompile(blem_sim_model ${common_headers})
target_include_directories(blem_sim_model SYSTEM PRIVATE ${PCL_INCLUDE_DIRS} ${ASSIMP_INCLUDE_DIRS})
target_link_libraries(blem_sim_model PRIVATE PkgConfig::URDFDOM PkgConfig::CONSOLE_BRIDGE PkgConfig::TINYXML2 PkgConfig::TBB assimp fmt::fmt
  ${PCL_COMMON_LIBRARIES} ${PCL_IO_LIBRARIES} ${PCL_FEATURES_LIBRARIES} ${PCL_FILTERS_LIBRARIES} ${PCL_KDTREE_LIBRARIES}
  ${PCL_SEARCH_LIBRARIES} ${PCL_SURFACE_LIBRARIES})
blem_sim_room(contact blem_sim_geometry)
target_link_libraries(blem_sim_contact PRIVATE PkgConfig::TBB)
blem_sim_precompiled_as(blem_sim_contact blem_sim_geometry)
blem_sim_room(reduction blem_sim_contact)
blem_sim_precompiled_as(blem_sim_reduction blem_sim_geometry)
target_link_libraries(blem_sim_reduction PRIVATE PkgConfig::TBB)

# What takes most of the time of sanitized runs.
if(BLEM_SIM_SANITIZE)
  set(vector_code -O2)
endif()

# The kernels of the contact search, one source for several instruction sets; the fastest that the machine has is chosen when it runs.
set(kernels ${PROJECT_SOURCE_DIR}/src/contact/kernels)
set_source_files_properties(${kernels}/kernels_avx2.cpp ${kernels}/kernels_avx512.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_sources(blem_sim_contact PRIVATE ${kernels}/kernels_avx2.cpp ${kernels}/kernels_avx512.cpp)
  set_source_files_properties(${kernels}/kernels_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;${vector_code}")
  # GCC 12 warns of its own headers there.
  set_source_files_properties(${kernels}/kernels_avx512.cpp PROPERTIES COMPILE_OPTIONS
    "-mavx512f;-mavx512dq;-mavx512vl;-mavx512bw;-mprefer-vector-width=512;-Wno-maybe-uninitialized;-Wno-uninitialized;${vector_code}")
  set_source_files_properties(${kernels}/kernels.cpp PROPERTIES COMPILE_DEFINITIONS BLEM_SIM_X86_KERNELS)
endif()

# Square roots and comparisons as vector code; changes no result, only what becomes of errno and the flags of exceptions.
foreach(lanes reduction/lanes/reduction_lanes dynamics/lanes/contact_lanes dynamics/lanes/joint_lanes dynamics/lanes/sweep_lanes)
  # Without precompiled headers, which bring their own options.
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/${lanes}.cpp PROPERTIES COMPILE_OPTIONS "-fno-math-errno;-fno-trapping-math;${vector_code}"
    SKIP_PRECOMPILE_HEADERS ON)
endforeach()
blem_sim_room(dynamics blem_sim_contact blem_sim_model)
blem_sim_precompiled_as(blem_sim_dynamics blem_sim_geometry)
target_link_libraries(blem_sim_dynamics PRIVATE PkgConfig::ODE PkgConfig::TBB fmt::fmt)
blem_sim_room(sim blem_sim_dynamics blem_sim_reduction)
blem_sim_precompiled_as(blem_sim_sim blem_sim_geometry)
target_link_libraries(blem_sim_sim PUBLIC yaml-cpp fmt::fmt PRIVATE PkgConfig::TBB)
