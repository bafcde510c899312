lgabench_unit_test(sampler_test SHARDS 8 SOURCES sampler_test.cpp meant_scenes_test.cpp LINK lgabench_tabletop)
target_compile_options(sampler_test PRIVATE -O1)
lgabench_unit_test(scene_hashes_test SOURCES scene_hashes_test.cpp LINK lgabench_tabletop)
target_compile_definitions(scene_hashes_test PRIVATE
  LGABENCH_SCENE_HASHES="${CMAKE_CURRENT_SOURCE_DIR}/scene_hashes.txt")
lgabench_unit_test(pressure_test SOURCES pressure_test.cpp LINK lgabench_cell lgabench_harness lgabench_tabletop)
add_dependencies(pressure_test engines)
lgabench_unit_test(unheard_test SOURCES unheard_test.cpp LINK lgabench_harness lgabench_statistics lgabench_tabletop)
target_compile_options(unheard_test PRIVATE -O1)
