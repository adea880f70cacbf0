# The tests use SPARK_REFERENCE_DIR of the environment in which ctest runs; the value from the configuration is the
# default.
file(WRITE ${CMAKE_BINARY_DIR}/environment.cmake "if(NOT DEFINED ENV{SPARK_REFERENCE_DIR})\n  set(ENV{SPARK_REFERENCE_DIR} [==[${SPARK_REFERENCE_DIR}]==])\nendif()\n")
if(NOT SPARK_SANITIZER STREQUAL "none")
  # Before g++ 13, the sanitizers mistake thread-local blocks whose address happens to end in 0x010 for those of an old
  # C library, read out of bounds and crash.
  foreach(name ASAN_OPTIONS TSAN_OPTIONS)
    file(APPEND ${CMAKE_BINARY_DIR}/environment.cmake "set(ENV{${name}} \"intercept_tls_get_addr=0:\$ENV{${name}}\")\n")
  endforeach()
endif()
set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_BINARY_DIR}/environment.cmake)

# Optimize for compile time: tests run for seconds, but compiling them takes minutes.
set(SPARK_TEST_OPTIONS $<$<CONFIG:Release>:-O1>)

# Seconds after which a test is considered to hang. These are last resorts, long enough for slow and busy machines. The
# second one is for tests that take a minute on a fast machine, or wait for programs with the patience of
# tests/patience.h.
set(SPARK_TEST_TIMEOUT 2400)
set(SPARK_LONG_TEST_TIMEOUT 4800)

# Makes a test depend on a plugin. It is called last, when all plugins are known.
function(spark_test_needs target plugin)
  if(TARGET plugin-${plugin})
    add_dependencies(${target} plugin-${plugin})
  else()
    message(WARNING "${target} needs plugin '${plugin}', which is not there")
  endif()
endfunction()

# spark_test(<name> SOURCES ... [PROGRAM ...] [LIBRARIES ...] [LABELS ...] [PLUGINS ...] [NEEDS ...] [TIMEOUT ...]): a
# ctest test.
# PROGRAM: the Catch2 program test-<program> that contains it, <name> by default. Several tests may share a program:
# their sources are compiled together, and each test runs the test cases of its own *_test.cpp in a separate process.
# PLUGINS: names of plugins that must be built first; NEEDS: other targets that must be built first.
# Exit code 77 counts as skipped.
function(spark_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT;PROGRAM" "SOURCES;LIBRARIES;LABELS;PLUGINS;NEEDS" ${ARGN})
  if(NOT SPARK_BUILD_TESTS)
    return()
  endif()
  if(ARG_PROGRAM)
    set(target test-${ARG_PROGRAM})
  else()
    set(target test-${name})
  endif()
  if(NOT TARGET ${target})
    add_executable(${target})
    set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests DEFINE_SYMBOL "")
    target_link_libraries(${target} PRIVATE spark-test-main Spark::spark Spark::plugin)
    target_compile_definitions(${target} PRIVATE SPARK_SOURCES="${CMAKE_SOURCE_DIR}")
    target_compile_options(${target} PRIVATE ${SPARK_TEST_OPTIONS})
    target_precompile_headers(${target} REUSE_FROM spark-test-pch)
    target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  endif()
  set(cases)
  get_target_property(known ${target} SOURCES)
  foreach(source ${ARG_SOURCES})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    cmake_path(GET source STEM stem)
    if(stem MATCHES "_test$")
      list(APPEND cases "[#${stem}]")
    endif()
    if(NOT source IN_LIST known)
      target_sources(${target} PRIVATE ${source})
    endif()
  endforeach()
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES})
  foreach(plugin ${ARG_PLUGINS})
    cmake_language(EVAL CODE "cmake_language(DEFER DIRECTORY [[${CMAKE_SOURCE_DIR}]] CALL spark_test_needs ${target} ${plugin})")
  endforeach()
  if(ARG_NEEDS)
    add_dependencies(${target} ${ARG_NEEDS})
  endif()
  foreach(label ${ARG_LABELS})  # tests-<label>: everything that `ctest -L <label>` needs
    if(NOT TARGET tests-${label})
      add_custom_target(tests-${label})
    endif()
    add_dependencies(tests-${label} ${target})
  endforeach()
  if(ARG_PROGRAM)
    list(JOIN cases "," cases)
    add_test(NAME ${name} COMMAND ${target} --filenames-as-tags --warn NoTests ${cases})
  else()
    add_test(NAME ${name} COMMAND ${target})
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT ${SPARK_TEST_TIMEOUT})
  endif()
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
