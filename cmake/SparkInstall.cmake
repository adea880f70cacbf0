# The relocatable tree: bin/ lib/ include/ share/spark, and the CMake package.
include(CMakePackageConfigHelpers)
list(TRANSFORM SPARK_FLOORS PREPEND spark- OUTPUT_VARIABLE floors)
add_dependencies(programs ${floors})
if(TARGET viewer)
  add_dependencies(programs viewer)
endif()
install(TARGETS spark ${floors} spark-plugin-interface EXPORT SparkTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(folder ${SPARK_HEADER_FOLDERS})
  install(DIRECTORY ${folder}/spark DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/generated/spark DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY plugins/api DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY lua/ DESTINATION ${CMAKE_INSTALL_DATADIR}/spark/lua)
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/spark/scenes)
install(EXPORT SparkTargets NAMESPACE Spark:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Spark)
set(SPARK_INSTALL_PLUGINS ${CMAKE_INSTALL_LIBDIR}/spark/plugins)
set(SPARK_INSTALL_SHARE ${CMAKE_INSTALL_DATADIR}/spark)
configure_package_config_file(cmake/SparkConfig.cmake.in ${CMAKE_BINARY_DIR}/SparkConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Spark PATH_VARS SPARK_INSTALL_PLUGINS SPARK_INSTALL_SHARE)

# Documentation, in the same folders as in the source tree, so that links between pages work.
file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} *.md LICENSE docs/*.md docs/pictures/*.png docs/pictures/*.svg lua/*.md scenes/*.md plugins/README.md plugins/*/README.md plugins/*-team/*/README.md tools/*/README.md tests/*/README.md
  plugins/sensors/gyro_rate_perceptor.h)
foreach(page ${pages})
  get_filename_component(folder ${page} DIRECTORY)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/spark/${folder})
endforeach()
write_basic_package_version_file(${CMAKE_BINARY_DIR}/SparkConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_BINARY_DIR}/SparkConfig.cmake ${CMAKE_BINARY_DIR}/SparkConfigVersion.cmake cmake/SparkPlugin.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Spark)
