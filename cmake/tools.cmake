# Programs without ROS.
file(GLOB run_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/tools/blem_sim_run/*.cpp)
if(run_sources)
  add_executable(blem_sim_run ${run_sources})
  target_link_libraries(blem_sim_run blem_sim_sim)
endif()

# The makers of meshes/, kept so that these can be made again; the test of the geometry room runs them.
file(GLOB scene_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/tools/make_demo_scenes/*.cpp)
add_executable(make_demo_scenes ${scene_sources})
target_link_libraries(make_demo_scenes blem_sim_geometry)
