#include "../probe.hpp"

LGABENCH_METHOD("fixture_probe", "0.1", "tries to reach out of its process", Probe, probe_options)
