# What every target of this project shares.

include(LgabenchPlugin)

# A shared library of the framework: one copy in a process, found by DT_NEEDED. lgabench_NAME is lgabench::NAME to those
# who link it, here and from the package.
function(lgabench_library target)
  add_library(${target} SHARED ${ARGN})
  string(REPLACE "lgabench_" "" name ${target})
  add_library(lgabench::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} INSTALL_RPATH "$ORIGIN"
                                             CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/framework>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  lgabench_target(${target})
endfunction()

# An environment: lgabench_NAME, the library lgabench_env_NAME beside the framework's own, where find_environment() finds it.
function(lgabench_environment name)
  lgabench_library(lgabench_${name} ${ARGN})
  set_target_properties(lgabench_${name} PROPERTIES OUTPUT_NAME lgabench_env_${name})
  target_link_libraries(lgabench_${name} PUBLIC lgabench_core)
  target_include_directories(lgabench_${name} PUBLIC ${PROJECT_SOURCE_DIR}/envs)  # it is not installed for others to link
  install(TARGETS lgabench_${name})
  foreach(program ${lgabench_programs})
    add_dependencies(${program} lgabench_${name})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY lgabench_environments lgabench_${name})  # whatever reads scenarios needs them all
endfunction()

# Headers that most files of some targets include, compiled once: target_precompile_headers(TARGET REUSE_FROM GROUP) of targets
# with the flags that hold where this is called.
function(lgabench_precompile group)
  file(CONFIGURE OUTPUT ${group}.cpp CONTENT "")
  add_library(${group} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${group}.cpp)
  target_link_libraries(${group} PRIVATE lgabench_core)
  lgabench_target(${group})
  target_precompile_headers(${group} PRIVATE ${ARGN})
endfunction()

# What plugins include, by name: it is installed, and has pages (docs/Doxyfile.in). All else is private, whatever its
# folder: what a method may not see, or what a later version may change.
set(lgabench_public_headers
    core/action.hpp core/environment.hpp core/environments.hpp core/error.hpp core/feature_space.hpp core/files.hpp core/geometry.hpp core/json.hpp
    core/language_model.hpp core/meaning.hpp core/method.hpp core/observation.hpp core/observation_perturbation.hpp core/perceiver.hpp core/physics_world.hpp core/random.hpp core/sampling.hpp core/scenario.hpp core/scene.hpp core/selection.hpp
    core/shown.hpp core/turns.hpp core/version.hpp core/view.hpp
    plugin/descriptor.hpp plugin/environment.hpp plugin/fingerprint.hpp plugin/plugin.hpp plugin/simple_environment.hpp
    abstraction/goal_mask.hpp abstraction/repaint.hpp abstraction/select_features.hpp
    learning/archive.hpp learning/cloning_method.hpp learning/featurizer.hpp learning/inputs.hpp learning/learner.hpp learning/noisy_copies.hpp
    learning/samples.hpp learning/torch_learner.hpp)

# What `find_package(lgabench CONFIG)` finds: the libraries that plugins link, their headers, lgabench_add_plugin().
function(lgabench_install_package)
  include(CMakePackageConfigHelpers)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/lgabench)
  install(TARGETS lgabench_core lgabench_learning lgabench_openai EXPORT lgabenchTargets)
  if(LGABENCH_TORCH)
    install(TARGETS lgabench_encoder)  # the programs need it, plugins do not
  endif()
  install(EXPORT lgabenchTargets NAMESPACE lgabench:: DESTINATION ${package})
  foreach(header ${lgabench_public_headers})
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${PROJECT_SOURCE_DIR}/framework/lgabench/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lgabench/${folder})
  endforeach()
  # An SDK of another version is refused when a plugin is read; CMake may say so first.
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/lgabenchConfigVersion.cmake COMPATIBILITY ExactVersion)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/lgabenchConfig.cmake ${PROJECT_SOURCE_DIR}/cmake/LgabenchPlugin.cmake
                ${PROJECT_SOURCE_DIR}/cmake/FindOpenCV.cmake
                ${PROJECT_BINARY_DIR}/lgabenchConfigVersion.cmake DESTINATION ${package})
endfunction()

# Data lies in the build tree where the installed programs look for it.
function(lgabench_link_data)
  set(share ${PROJECT_BINARY_DIR}/share/lgabench)
  file(MAKE_DIRECTORY ${share})
  # Of all environments together: ids are the files' names.
  foreach(kind scenarios suites suites/claims spaces lexicons)
    file(REMOVE_RECURSE ${share}/${kind})
    file(MAKE_DIRECTORY ${share}/${kind})
    file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/envs/*/${kind}/*.json)
    foreach(file ${files})
      cmake_path(GET file FILENAME name)
      if(EXISTS ${share}/${kind}/${name})
        message(FATAL_ERROR "${file}: another environment has ${kind}/${name}")
      endif()
      file(CREATE_LINK ${file} ${share}/${kind}/${name} SYMBOLIC)
    endforeach()
    install(FILES ${files} DESTINATION ${CMAKE_INSTALL_DATADIR}/lgabench/${kind})
  endforeach()
  # An environment's own data, as share/lgabench/ID.
  set(tables)
  file(GLOB directories CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/envs ${PROJECT_SOURCE_DIR}/envs/*/tables)
  foreach(directory ${directories})
    cmake_path(GET directory PARENT_PATH name)
    list(APPEND tables ${name}:envs/${directory})
  endforeach()
  # What reads names from an environment's pictures, as share/lgabench/readers/ID.
  file(GLOB directories CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/envs ${PROJECT_SOURCE_DIR}/envs/*/readers)
  file(MAKE_DIRECTORY ${share}/readers)
  foreach(directory ${directories})
    cmake_path(GET directory PARENT_PATH name)
    list(APPEND tables readers/${name}:envs/${directory})
  endforeach()
  set(of_programs)
  if(LGABENCH_PROGRAMS)
    set(of_programs page:programs/lgabench/document/page templates:programs/lgabench/cli/templates
                    study:programs/lgabench/study/pages protocols:programs/lgabench/study/protocols)
  endif()
  foreach(pair ${tables} answers:framework/lgabench/abstraction/answers disputed:framework/lgabench/abstraction/disputed
               prompts:framework/lgabench/abstraction/prompts
               embeddings:framework/lgabench/learning/embeddings paper:results/paper measured:results/measured formats:docs/formats
               starters:examples ${of_programs} persons:framework/lgabench/drawn/persons python:python fetch:cmake/fetch)
    string(REPLACE ":" ";" pair ${pair})
    list(GET pair 0 name)
    list(GET pair 1 source)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${source} ${share}/${name} SYMBOLIC)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${source}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lgabench/${name}
            PATTERN __pycache__ EXCLUDE PATTERN package EXCLUDE)  # python/package is the wheel's
  endforeach()
  # Pages and examples, so that an installation needs no sources.
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
          PATTERN __pycache__ EXCLUDE)
  install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/LICENSE
          ${PROJECT_SOURCE_DIR}/SECURITY.md ${PROJECT_SOURCE_DIR}/CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
  # The terms of what is compiled in; libraries have their own where they are packed (wheel.py).
  file(GLOB terms /usr/share/doc/libcli11-dev/copyright /usr/share/doc/nlohmann-json3-dev/copyright /usr/share/doc/libboost1.*-dev/copyright)
  foreach(file ${terms})
    cmake_path(GET file PARENT_PATH of)
    cmake_path(GET of FILENAME of)
    install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/licenses/${of})
  endforeach()
  if(LGABENCH_PROGRAMS)  # What a packed leaderboard has beside its entries.
    file(MAKE_DIRECTORY ${share}/archive)
    foreach(source LICENSE CITATION.cff programs/lgabench/leaderboard/archive/README.md)
      cmake_path(GET source FILENAME name)
      file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${source} ${share}/archive/${name} SYMBOLIC)
      install(FILES ${PROJECT_SOURCE_DIR}/${source} DESTINATION ${CMAKE_INSTALL_DATADIR}/lgabench/archive)
    endforeach()
  endif()
  # Where cmake/build fetches the sentence encoder's weights; there are none without network.
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/.deps/encoder ${share}/encoder SYMBOLIC)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/.deps/encoder/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lgabench/encoder OPTIONAL)
endfunction()
