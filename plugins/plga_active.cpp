// PLGA whose person says of objects whether they would take them.
#include <lgabench/plugin/plugin.hpp>

#include "plga.hpp"

LGABENCH_METHOD_ASKING("accept", "plga_active", "0.2",
                       "Behaviour cloning on a goal mask of what a person prefers, who was shown objects", Plga,
                       "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                       "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS PLGA_UNLISTED
                       R"(,"questions": {"default": 1, "min": 0, "help": "objects that the person is shown at most",)"
                       R"("source": "ours"}})")
