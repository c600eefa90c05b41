add_library(trajectory_msgs::trajectory_msgs INTERFACE IMPORTED)
target_include_directories(trajectory_msgs::trajectory_msgs INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../include)
set(trajectory_msgs_TARGETS trajectory_msgs::trajectory_msgs)
