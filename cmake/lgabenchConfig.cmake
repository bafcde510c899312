# find_package(lgabench CONFIG REQUIRED): lgabench::core, lgabench::learning, lgabench::openai, lgabench_add_plugin().
include(CMakeFindDependencyMacro)
find_dependency(fmt)
find_dependency(nlohmann_json)
include(${CMAKE_CURRENT_LIST_DIR}/lgabenchTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/LgabenchPlugin.cmake)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})  # OpenCV by its parts, for plugins that look for it
