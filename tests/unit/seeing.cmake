lgabench_unit_test(seeing_test READ SOURCES seeing_test.cpp LINK lgabench_grow lgabench_tabletop)
