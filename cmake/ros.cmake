# The ros room: its library, the node, what is installed, the rostests.
blem_sim_room(ros blem_sim_sim)
add_dependencies(blem_sim_ros ${PROJECT_NAME}_generate_messages_cpp)
target_include_directories(blem_sim_ros SYSTEM PUBLIC ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS})
target_link_libraries(blem_sim_ros PUBLIC ${catkin_LIBRARIES})
blem_sim_precompile(blem_sim_ros ${common_headers} ${ros_headers})

add_executable(blem_sim_node ${PROJECT_SOURCE_DIR}/src/ros_node/blem_sim_node.cpp ${PROJECT_SOURCE_DIR}/src/ros_node/limited_new.cpp)
target_include_directories(blem_sim_node PRIVATE ${PROJECT_SOURCE_DIR}/src/ros)
target_link_libraries(blem_sim_node blem_sim_ros)
add_executable(replay ${PROJECT_SOURCE_DIR}/src/ros_node/replay_main.cpp)
target_include_directories(replay PRIVATE ${PROJECT_SOURCE_DIR}/src/ros)
target_link_libraries(replay blem_sim_ros)
# All that a demo runs, and no test: scripts/demo.
add_custom_target(demo DEPENDS blem_sim_node ${PROJECT_NAME}_generate_messages)

# Without catkin's relay in the devel space: rosrun, which looks below the package's folder and so in scripts/build's too, would find two.
install(PROGRAMS scripts/ros/expect_contacts_in_layer scripts/ros/play_trajectory scripts/ros/spawn_model scripts/ros/record scripts/ros/step_together
  scripts/sweep/blem_sim_sweep scripts/worlds/world_from_sdf DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(DIRECTORY scripts/sweep/sweeping scripts/worlds/sdf DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION} FILES_MATCHING PATTERN "*.py")
install(TARGETS blem_sim_node replay RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(TARGETS blem_sim_geometry blem_sim_model blem_sim_contact blem_sim_reduction blem_sim_dynamics blem_sim_sim blem_sim_ros
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
foreach(folder launch config rviz urdf meshes)
  if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${folder})
    # figure.launch runs scripts of the source folder.
    install(DIRECTORY ${folder} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION} PATTERN figure.launch EXCLUDE)
  endif()
endforeach()

if(CATKIN_ENABLE_TESTING)
  find_package(rostest REQUIRED)
  file(GLOB rostests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/ros/*.test ${PROJECT_SOURCE_DIR}/test/ros/*/*.test)
  foreach(rostest ${rostests})
    add_rostest(${rostest} DEPENDENCIES blem_sim_node replay)
  endforeach()
endif()
