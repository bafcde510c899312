#include "plga.hpp"

#include <lgabench/plugin/plugin.hpp>

LGABENCH_METHOD("plga", "0.2", "Behaviour cloning on a goal mask of what a person is likely to prefer", Plga,
                "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS PLGA_UNLISTED "}")
