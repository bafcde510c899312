// PLGA whose person says of one object whether they would take it.
#include <lgabench/plugin/plugin.hpp>

#include "plga.hpp"

LGABENCH_METHOD_ASKING("accept", "plga_active", "0.1",
                       "Behaviour cloning on a goal mask of what a person prefers, who was shown one object",
                       Plga<lgabench::AskPerson::yes>,
                       "{" LGABENCH_QUESTIONNAIRE LGABENCH_MEANING_OPTION "," LGABENCH_CLONING_OPTIONS
                       "," LGABENCH_PICTURE_OPTION "," LGABENCH_MASK_OPTIONS "}")
