# Programs without ROS.
file(GLOB common_tool_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/tools/common/*.cpp)
add_library(blem_sim_tools STATIC ${common_tool_sources})
target_include_directories(blem_sim_tools PUBLIC ${PROJECT_SOURCE_DIR}/src/tools/common)
target_link_libraries(blem_sim_tools PUBLIC blem_sim_sim)

file(GLOB run_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/tools/blem_sim_run/*.cpp)
if(run_sources)
  add_executable(blem_sim_run ${run_sources})
  file(STRINGS ${PROJECT_SOURCE_DIR}/package.xml version REGEX "<version>")
  string(REGEX REPLACE ".*<version>(.*)</version>.*" "\\1" version "${version}")
  target_compile_definitions(blem_sim_run PRIVATE
    BLEM_SIM_VERSION="${version} \(${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\)")
  target_link_libraries(blem_sim_run blem_sim_tools)
endif()

# The makers of meshes/, kept so that these can be made again; the test of the geometry room runs them.
file(GLOB scene_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/tools/make_demo_scenes/*.cpp)
add_executable(make_demo_scenes ${scene_sources})
target_link_libraries(make_demo_scenes blem_sim_geometry)

# Pictures of worlds, drawn by the VTK that PCL brings. Before VTK 9 its parts have other names, and asking for one that is not there ends CMake.
set(vtk_parts CommonCore CommonDataModel CommonExecutionModel RenderingCore RenderingOpenGL2 IOImage)
find_package(VTK 9 QUIET COMPONENTS ${vtk_parts})
if(NOT VTK_FOUND)
  find_package(VTK QUIET)
  list(TRANSFORM vtk_parts PREPEND vtk OUTPUT_VARIABLE VTK_LIBRARIES)
endif()
if(NOT TARGET VTK::RenderingOpenGL2 AND NOT TARGET vtkRenderingOpenGL2)
  message(STATUS "blem_sim: view_world is left out: VTK with OpenGL 2 is missing")
  return()
endif()
file(GLOB view_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/tools/view_world/*.cpp)
add_executable(view_world ${view_sources})
target_include_directories(view_world SYSTEM PRIVATE ${VTK_INCLUDE_DIRS})
target_link_libraries(view_world blem_sim_tools ${VTK_LIBRARIES})
if(BLEM_SIM_WITH_ROS)
  install(TARGETS view_world RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
