# What every target of this project shares.

# Warnings, flags and the two include roots: framework/ for <lgabench/...>, envs/ for <tabletop/...>.
function(lgabench_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                           $<$<BOOL:${LGABENCH_WERROR}>:-Werror>
                                           $<$<BOOL:${LGABENCH_NATIVE}>:-march=native>)
  # A fused multiply-add on one machine and not on another would make two results of one computation.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
endfunction()

# A shared library of the framework: one copy in a process, found by DT_NEEDED.
function(lgabench_library target)
  add_library(${target} SHARED ${ARGN})
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/framework>
                                              $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/envs>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  lgabench_target(${target})
endfunction()

# One plugin from its sources: lgabench_add_plugin(lga lga.cpp). It is shipped, unless DIRECTORY names another place.
function(lgabench_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 P "" "DIRECTORY" "")
  add_library(${name} MODULE ${P_UNPARSED_ARGUMENTS})
  # Hidden symbols: two plugins may have classes of one name.
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(${name} PRIVATE lgabench_core)
  lgabench_target(${name})
  if(P_DIRECTORY)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${P_DIRECTORY})
  else()
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${LGABENCH_PLUGIN_DIRECTORY})
    install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/lgabench/plugins)
  endif()
endfunction()

# Data lies in the build tree where the installed programs look for it.
function(lgabench_link_data)
  set(share ${PROJECT_BINARY_DIR}/share/lgabench)
  file(MAKE_DIRECTORY ${share})
  foreach(pair scenarios:envs/tabletop/scenarios suites:envs/tabletop/suites spaces:envs/tabletop/spaces
               answers:framework/lgabench/abstraction/answers prompts:framework/lgabench/abstraction/prompts
               embeddings:framework/lgabench/learning/embeddings paper:results/paper formats:docs/formats
               page:framework/lgabench/report/page)
    string(REPLACE ":" ";" pair ${pair})
    list(GET pair 0 name)
    list(GET pair 1 source)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${source} ${share}/${name} SYMBOLIC)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${source}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lgabench/${name})
  endforeach()
  # cmake/encoder puts the sentence encoder's weights there; too large to install.
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/.deps/encoder ${share}/encoder SYMBOLIC)
endfunction()
