# The Python module: blem_sim/__init__.py, and the extension blem_sim._simulator beside it, left out where pybind11 is missing. With ROS both go
# to where the messages' Python types are, else to python/ in the build folder.
if(BLEM_SIM_SANITIZE)
  return()
endif()
# One interpreter for pybind11 before 2.6, which asks for PYTHON_EXECUTABLE, and later ones, which ask for Python3.
if(PYTHON_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
endif()
find_package(Python3 QUIET COMPONENTS Interpreter Development)
set(PYBIND11_PYTHON_VERSION ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR})
find_package(pybind11 2.4 QUIET)
if(NOT Python3_Development_FOUND OR NOT pybind11_FOUND)
  message(STATUS "blem_sim: the Python module is left out: python3-dev or pybind11-dev is missing")
  return()
endif()

file(GLOB python_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/*.cpp)
set(common ${PROJECT_SOURCE_DIR}/src/tools/common)
# Not all of blem_sim_tools, whose operator new is one for programs.
pybind11_add_module(_simulator NO_EXTRAS ${python_sources} ${common}/run_setup.cpp ${common}/overrides.cpp)
target_include_directories(_simulator PRIVATE ${common})
target_link_libraries(_simulator PRIVATE blem_sim_sim)
if(BLEM_SIM_WITH_ROS)
  set_target_properties(_simulator PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_PYTHON_DESTINATION})
  # Rooms' libraries from below the same prefix, wherever it is moved to.
  file(RELATIVE_PATH libraries /${CATKIN_PACKAGE_PYTHON_DESTINATION} /${CATKIN_PACKAGE_LIB_DESTINATION})
  set_target_properties(_simulator PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  install(TARGETS _simulator LIBRARY DESTINATION ${CATKIN_PACKAGE_PYTHON_DESTINATION})
else()
  set_target_properties(_simulator PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/blem_sim)
  configure_file(${PROJECT_SOURCE_DIR}/src/python/blem_sim/__init__.py ${PROJECT_BINARY_DIR}/python/blem_sim/__init__.py COPYONLY)
endif()
