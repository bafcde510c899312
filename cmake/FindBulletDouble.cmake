# Bullet in double precision. Debian's package holds both builds; the plain BulletConfig.cmake is the one in floats.
find_package(Bullet QUIET CONFIG CONFIGS BulletConfig-float64.cmake)
set(libraries)
foreach(name BulletDynamics BulletCollision LinearMath)  # in the order in which they need one another
  find_library(BulletDouble_${name}_LIBRARY ${name}-float64)
  list(APPEND libraries BulletDouble_${name}_LIBRARY)
endforeach()
find_path(BulletDouble_INCLUDE_DIR btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletDouble REQUIRED_VARS ${libraries} BulletDouble_INCLUDE_DIR
                                  VERSION_VAR BULLET_VERSION_STRING)
if(BulletDouble_FOUND AND NOT TARGET bullet::bullet)
  add_library(bullet::bullet INTERFACE IMPORTED)
  target_include_directories(bullet::bullet SYSTEM INTERFACE ${BulletDouble_INCLUDE_DIR})
  target_compile_definitions(bullet::bullet INTERFACE BT_USE_DOUBLE_PRECISION)
  foreach(library ${libraries})
    target_link_libraries(bullet::bullet INTERFACE ${${library}})
  endforeach()
endif()
