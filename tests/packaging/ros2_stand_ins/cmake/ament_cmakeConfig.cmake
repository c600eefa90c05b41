macro(ament_export_targets name)
  install(EXPORT ${name} DESTINATION share/${PROJECT_NAME}/cmake NAMESPACE ${PROJECT_NAME}::
    FILE ${PROJECT_NAME}Config.cmake)
endmacro()
macro(ament_package)
  install(FILES package.xml DESTINATION share/${PROJECT_NAME})
endmacro()
