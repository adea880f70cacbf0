# spark_plugin(<name> SOURCES ... [LIBRARIES ...]): one plugin, <name>.so, target plugin-<name>.
# Used by Spark's own plugins and, from the installed package, by plugins of other projects.
function(spark_plugin name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(target plugin-${name})
  add_library(${target} MODULE ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name} DEFINE_SYMBOL ""
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(${target} PRIVATE Spark::plugin ${ARG_LIBRARIES})
  # A function that nothing defines is an error here, not when a host loads the plugin. Clang cannot: it links the
  # runtime of a sanitizer to programs alone.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_link_options(${target} PRIVATE LINKER:-z,defs)
  endif()
  if(TARGET spark-pch)  # inside the project
    set_target_properties(${target} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/plugins
      INSTALL_RPATH "$ORIGIN/../..")
    target_precompile_headers(${target} REUSE_FROM spark-pch)
    if(NOT TARGET plugins)
      add_custom_target(plugins)
    endif()
    add_dependencies(plugins ${target})
    add_dependencies(programs ${target})
    install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/spark/plugins)
  endif()
endfunction()
