// Says it was compiled against another LibTorch.
#define LGABENCH_TORCH_VERSION "9.9.9"
#include "../fixture.hpp"

LGABENCH_METHOD("wrong_torch", "0.1", "built with another LibTorch", fixture::FixtureMethod<fixture::StayPolicy>, "{}")
