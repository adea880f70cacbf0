# Compiler settings of the project itself, and the generated headers.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_DEBUG "-Og -g1")

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} ${CCACHE})
endif()

# Unity builds compile several sources at a time, so that headers are parsed and templates instantiated only once. With
# OFF, missing includes are detected.
option(SPARK_UNITY "Compile the sources of a target together" ON)
set(CMAKE_UNITY_BUILD ${SPARK_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)

# Use a faster linker if it is available.
find_program(SPARK_MOLD mold)
if(SPARK_MOLD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_link_options(-fuse-ld=mold)
endif()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

# g++ 12 has false positives of maybe-uninitialized for members of std::variant.
# No contraction of a*b+c and no fast math, so that every build gives the same digits.
add_compile_options(-Wall -Wextra -Wpedantic -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_compile_options(-Wno-gnu-zero-variadic-macro-arguments)
endif()
if(SPARK_SANITIZER STREQUAL "address")
  # The four disabled checks would take a third of the compile time. Null pointers end a program anyway.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=null,alignment,vptr,object-size -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
elseif(SPARK_SANITIZER STREQUAL "thread")
  # Boost.Asio uses fences that the thread sanitizer does not model; g++ warns about every use.
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer $<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
  add_link_options(-fsanitize=thread)
endif()

# The generated headers: versions, and stamps of the public headers.
include(SparkAbi)
set(SPARK_FLOORS base message kernel script)  # the libraries of core/
configure_file(${CMAKE_SOURCE_DIR}/core/kernel/abi.h.in ${CMAKE_BINARY_DIR}/generated/spark/abi.h)
set(SPARK_HEADER_FOLDERS ${SPARK_FLOORS})
list(TRANSFORM SPARK_HEADER_FOLDERS REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/core/\\1/include")
spark_stamp_headers(SPARK_HEADERS ${CMAKE_BINARY_DIR}/generated ${SPARK_HEADER_FOLDERS} ${CMAKE_SOURCE_DIR}/plugins)
