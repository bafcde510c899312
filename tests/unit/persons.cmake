lgabench_unit_test(persons_test READ SOURCES persons_test.cpp LINK lgabench_drawn)
