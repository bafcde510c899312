# MuJoCo from its Python wheel, which `cmake/setup` unpacks: the library has no unversioned name, so its full path is imported.
set(MUJOCO_ROOT ${PROJECT_SOURCE_DIR}/.deps/mujoco CACHE PATH "Where the wheel's mujoco/ folder lies")
find_path(MuJoCoWheel_INCLUDE_DIR mujoco/mujoco.h PATHS ${MUJOCO_ROOT}/include NO_DEFAULT_PATH)
find_file(MuJoCoWheel_LIBRARY libmujoco.so.3.17.0 PATHS ${MUJOCO_ROOT} NO_DEFAULT_PATH)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MuJoCoWheel REQUIRED_VARS MuJoCoWheel_LIBRARY MuJoCoWheel_INCLUDE_DIR)
if(MuJoCoWheel_FOUND AND NOT TARGET mujoco::mujoco)
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(mujoco::mujoco PROPERTIES IMPORTED_LOCATION ${MuJoCoWheel_LIBRARY}
                                                  INTERFACE_INCLUDE_DIRECTORIES ${MuJoCoWheel_INCLUDE_DIR})
endif()
