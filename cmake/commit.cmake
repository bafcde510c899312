# Writes OUT, a header with the commit of SOURCE, if it is another than OUT has. At every build: cmake -P commit.cmake
cmake_minimum_required(VERSION 3.25)
set(commit unknown)
if(DEFINED ENV{LGABENCH_COMMIT})  # where the sources come without their history, as into an image
  set(commit $ENV{LGABENCH_COMMIT})
elseif(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${said})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once\n#define LGABENCH_COMMIT \"@commit@\"\n" @ONLY)
