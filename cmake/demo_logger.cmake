# demo_logger_add_room(NAME SOURCES file.cpp … LINKS target …)
# One room of the house: library demo_logger_NAME. What it links is the architecture.
function(demo_logger_add_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS" ${ARGN})
  set(library ${PROJECT_NAME}_${name})
  add_library(${library} ${ROOM_SOURCES})
  target_include_directories(${library} PUBLIC ${PROJECT_SOURCE_DIR}/include)
  target_compile_options(${library} PRIVATE -Wall -Wextra)
  target_link_libraries(${library} PUBLIC ${ROOM_LINKS})
  install(TARGETS ${library}
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
endfunction()

# demo_logger_link_ros(target …): ROS headers and libraries; SYSTEM, so that their warnings are not ours.
function(demo_logger_link_ros)
  foreach(target ${ARGN})
    target_include_directories(${target} SYSTEM PRIVATE ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS})
    target_link_libraries(${target} ${catkin_LIBRARIES})
    add_dependencies(${target} ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
  endforeach()
endfunction()

# demo_logger_add_test(NAME file.cpp … LINKS target …): a gtest, built with everything else.
function(demo_logger_add_test name)
  cmake_parse_arguments(TEST "" "" "LINKS" ${ARGN})
  catkin_add_gtest(${name} ${TEST_UNPARSED_ARGUMENTS} ${PROJECT_SOURCE_DIR}/test/main.cpp)
  target_compile_options(${name} PRIVATE -Wall -Wextra)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  target_compile_definitions(${name} PRIVATE DEMO_LOGGER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} ${TEST_LINKS})
  set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL FALSE)
endfunction()
