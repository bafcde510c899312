if(LGABENCH_BULLET)
  lgabench_unit_test(bullet_test SOURCES bullet_test.cpp ${PROJECT_SOURCE_DIR}/envs/bullet/bullet_world.cpp
                                         ${PROJECT_SOURCE_DIR}/envs/bullet/bullet_models.cpp
                     LINK lgabench_tabletop bullet::bullet)
endif()
