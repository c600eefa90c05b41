add_library(std_msgs::std_msgs INTERFACE IMPORTED)
target_include_directories(std_msgs::std_msgs INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../include)
set(std_msgs_TARGETS std_msgs::std_msgs)
