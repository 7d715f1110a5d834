# Two ways to compile faster where ccache is not at hand. Off unless asked for: ccache keeps nothing that is built with precompiled headers,
# and builds without either show what a file forgets to include (so does test/structure/includes_test.py). CMake has both since 3.16.
option(BLEM_SIM_PRECOMPILED_HEADERS "Precompile headers of other projects: a quarter to a third of what a file costs to compile" OFF)
option(BLEM_SIM_COMPILE_TOGETHER "Compile sixteen files of a target at once, which share templates: less than three fifths of what they cost one by one" OFF)
if(BLEM_SIM_COMPILE_TOGETHER)
  # Files of a target share no name in their unnamed namespaces (test/structure/unnamed_names_test.py).
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
  # Two compilers need 4 GB; freeing memory below 1 GB each would take a twelfth of their time.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    add_compile_options("SHELL:--param ggc-min-heapsize=1000000" "SHELL:--param ggc-min-expand=100")
  endif()
endif()

set(common_headers
  <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numeric> <set> <string> <utility> <vector>
  <Eigen/Core> <Eigen/Geometry>)
set(ros_headers
  <boost/make_shared.hpp> <diagnostic_updater/diagnostic_updater.h> <nav_msgs/Odometry.h> <ros/callback_queue.h> <ros/console.h>
  <ros/node_handle.h> <rosgraph_msgs/Clock.h> <sensor_msgs/JointState.h> <std_srvs/Empty.h> <tf2_msgs/TFMessage.h>
  <trajectory_msgs/JointTrajectory.h> <visualization_msgs/MarkerArray.h>)

if(BLEM_SIM_PRECOMPILED_HEADERS AND NOT CMAKE_VERSION VERSION_LESS 3.16)
  # Precompiles headers for a target.
  macro(blem_sim_precompile target)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endmacro()
  # Lets a target read what was precompiled for another of the same flags.
  macro(blem_sim_precompiled_as target other)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endmacro()
else()
  macro(blem_sim_precompile target)
  endmacro()
  macro(blem_sim_precompiled_as target other)
  endmacro()
endif()
