# Everything that `cmake --install` copies is built by one target: `programs`.
if(NOT TARGET programs)
  add_custom_target(programs)
endif()

# spark_program(<target>...): programs that are installed, and find the libraries of core/ beside them.
function(spark_program)
  foreach(target ${ARGN})
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
    install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    add_dependencies(programs ${target})
  endforeach()
endfunction()
