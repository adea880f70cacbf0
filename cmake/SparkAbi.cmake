# The ABI of public headers: what a plugin was compiled with is compared with what its host was built with, header by header.

# spark_header_hash(<out> <header>): 16 digits of the text that the compiler works on, that is, without comments, blank lines and runs of blanks.
function(spark_header_hash out header)
  file(READ ${header} rest)
  set(text "")
  # Code up to the next quote or slash, then a text or a character, in which // begins no comment, or a comment, or that one character.
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

# spark_stamp_headers(<out> <folder> <root>...): writes into <folder>, for each header spark/x.h or api/x.h of the include folders <root>, the
# stamp spark/abi/api/x.h that the header includes; <out> is the list of "api/x.h HASH". Every object file lists the stamps of the headers that
# it was compiled with in its section spark_headers; the linker joins the lists, and the plugin's descriptor says where the list is.
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
