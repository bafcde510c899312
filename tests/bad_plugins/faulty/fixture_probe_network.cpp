#include "../probe.hpp"

LGABENCH_METHOD_ASKING("network", "fixture_probe_network", "0.1", "likewise, with leave to open sockets", Probe,
                       probe_options)
