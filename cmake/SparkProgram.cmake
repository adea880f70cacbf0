# The target `programs` builds everything that `cmake --install` copies.
if(NOT TARGET programs)
  add_custom_target(programs)
endif()

# spark_program(<target>...): installs programs, which find the libraries of core/ by a relative path.
function(spark_program)
  foreach(target ${ARGN})
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
    install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    add_dependencies(programs ${target})
  endforeach()
endfunction()
