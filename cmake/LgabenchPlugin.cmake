# How a plugin is built: the same function, with the same flags, in this tree and from the installed package.

# Warnings and the flags that results depend on.
function(lgabench_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wnon-virtual-dtor
                                           # Files that are compiled as one see each other's names.
                                           "$<IF:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>,-Wshadow=local;-Wno-subobject-linkage,-Wshadow>"
                                           $<$<BOOL:${LGABENCH_WERROR}>:-Werror>
                                           $<$<BOOL:${LGABENCH_NATIVE}>:-march=native>)
  # A fused multiply-add on one machine and not on another would make two results of one computation.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  # What is built does not tell where (GoogleTest's macros hold the names of files).
  target_compile_options(${target} PRIVATE -fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=)
endfunction()

# One plugin from its sources: lgabench_add_plugin(my_method my_method.cpp [DIRECTORY D]). NAME.so is put into DIRECTORY,
# else into ${LGABENCH_PLUGIN_DIRECTORY}, else where CMake puts a target. Without DIRECTORY it is installed among the
# plugins of the prefix, where a program in the same prefix finds it.
# What else it needs is linked as usual: target_link_libraries(my_method PRIVATE lgabench::learning).
function(lgabench_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 P "" "DIRECTORY" "")
  add_library(${name} MODULE ${P_UNPARSED_ARGUMENTS})
  # Hidden symbols: two plugins may have classes of one name.
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_EXTENSIONS OFF
                                           CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                                           INSTALL_RPATH "$ORIGIN/../..;$ORIGIN/..")
  target_link_libraries(${name} PRIVATE lgabench::core)
  # Which LibTorch it is linked with, for its descriptor: a process can hold one, so lgabench refuses it beside another.
  target_compile_definitions(${name} PRIVATE
    $<$<IN_LIST:torch,$<TARGET_PROPERTY:${name},LINK_LIBRARIES>>:LGABENCH_TORCH_VERSION="${Torch_VERSION}">)
  # Without a build type CMake would not optimise at all.
  target_compile_options(${name} PRIVATE $<$<CONFIG:>:-O2>)
  lgabench_target(${name})
  if(P_DIRECTORY)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${P_DIRECTORY})
    return()
  endif()
  if(LGABENCH_PLUGIN_DIRECTORY)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${LGABENCH_PLUGIN_DIRECTORY})
  endif()
  install(TARGETS ${name} LIBRARY DESTINATION lib/lgabench/plugins)
endfunction()
