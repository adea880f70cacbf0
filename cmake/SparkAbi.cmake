# ABI check of public headers: the versions of the headers with which a plugin was compiled are compared with those of
# its host, header by header.

# spark_header_hash(<out> <header>): a hash of 16 hexadecimal digits of the header's text without comments, blank lines
# and repeated blanks.
function(spark_header_hash out header)
  file(READ ${header} rest)
  set(text "")
  # Matches code up to the next quote or slash, then one of: a string or character literal, in which // does not begin a
  # comment; a comment; that single character.
  while(rest MATCHES "^([^\"'/]*)(\"([^\"\\\n]|\\\\.)*\"|'([^'\\\n]|\\\\.)*'|//[^\n]*|/[*]([^*]|[*]+[^*/])*[*]+/|.)")
    set(code "${CMAKE_MATCH_1}")
    set(token "${CMAKE_MATCH_2}")
    string(LENGTH "${CMAKE_MATCH_0}" length)
    string(SUBSTRING "${rest}" ${length} -1 rest)
    if(token MATCHES "^/[/*]")
      set(token " ")
    endif()
    string(APPEND text "${code}${token}")
  endwhile()
  string(REGEX REPLACE "[ \t\r]+" " " text "${text}")
  string(REGEX REPLACE " ?\n[ \n]*" "\n" text "${text}")
  string(SHA256 hash "${text}")
  string(SUBSTRING ${hash} 0 16 hash)
  set(${out} ${hash} PARENT_SCOPE)
endfunction()

# spark_stamp_headers(<out> <folder> <root>...): writes into <folder>, for each header spark/x.h or api/x.h of the
# include folders <root>, the stamp spark/abi/api/x.h that the header includes; <out> is the list of "api/x.h HASH".
# Every object file lists the stamps of its headers in the section spark_headers; the linker concatenates the lists, and
# the plugin's descriptor points to the result.
function(spark_stamp_headers out folder)
  set(stamps)
  foreach(root ${ARGN})
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${root} ${root}/spark/*.h ${root}/api/*.h)
    foreach(header ${headers})
      set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${root}/${header})
      file(STRINGS ${root}/${header} line REGEX "^#include \"spark/abi/${header}\"$")
      if(NOT line)
        message(FATAL_ERROR "${root}/${header} is a public header and lacks the line\n  #include \"spark/abi/${header}\"")
      endif()
      spark_header_hash(hash ${root}/${header})
      string(MAKE_C_IDENTIFIER ${header} name)
      file(CONFIGURE OUTPUT ${folder}/spark/abi/${header} CONTENT [==[#pragma once
// Generated: which @header@ this is.
namespace spark::abi {
[[gnu::used, gnu::section("spark_headers")]] static const char @name@[] = "@header@ @hash@";
}
]==] @ONLY)
      list(APPEND stamps "${header} ${hash}")
    endforeach()
  endforeach()
  set(${out} ${stamps} PARENT_SCOPE)
endfunction()
