// No language: likeness is a count. The reference row most_demonstrated, as a mask under a policy.
#include <lgabench/plugin/plugin.hpp>

#include "of_taken.hpp"

using namespace lgabench;

class TakenFeaturesRow : public OfTaken {
 public:
  TakenFeaturesRow() : OfTaken([](const Instance& one, const TakenLooks& taken) { return taken.counted(one); }) {}
};

LGABENCH_METHOD("taken_features", "0.1",
                "Behaviour cloning on a mask of what looks most like what was taken, without language",
                TakenFeaturesRow,
                "{" LGABENCH_CLONING_OPTIONS "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
