# catkin: messages, services and what other packages see. Before any target, so that libraries land in the devel space.
set(BLEM_SIM_CATKIN_COMPONENTS
  actionlib
  actionlib_msgs
  diagnostic_msgs
  diagnostic_updater
  dynamic_reconfigure
  geometry_msgs
  nav_msgs
  rosbag_storage
  roscpp
  rosgraph_msgs
  sensor_msgs
  shape_msgs
  std_msgs
  std_srvs
  tf2_msgs
  tf2_ros
  trajectory_msgs
  visualization_msgs)
find_package(catkin REQUIRED COMPONENTS message_generation ${BLEM_SIM_CATKIN_COMPONENTS})

# Before generate_messages, which then leaves blem_sim/__init__.py of src/python alone, in the devel space and where it is installed.
catkin_python_setup()
file(GLOB messages CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/msg ${PROJECT_SOURCE_DIR}/msg/*.msg)
file(GLOB services CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/srv ${PROJECT_SOURCE_DIR}/srv/*.srv)
file(GLOB actions CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/action ${PROJECT_SOURCE_DIR}/action/*.action)
add_message_files(FILES ${messages})
add_service_files(FILES ${services})
add_action_files(FILES ${actions})
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs sensor_msgs std_msgs trajectory_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES blem_sim_geometry blem_sim_model blem_sim_contact blem_sim_reduction blem_sim_dynamics blem_sim_sim
  CATKIN_DEPENDS message_runtime ${BLEM_SIM_CATKIN_COMPONENTS}
  DEPENDS EIGEN3)
