#!/usr/bin/env bash
# Draws the pictures of docs/suites.md with `lgabench render`, and makes them smaller with ImageMagick's convert.
# Usage: docs/pictures/suites.sh [LGABENCH]
set -euo pipefail
cd "$(dirname "$0")/suites"
lgabench=${1:-../../../build/release/bin/lgabench}
scene=$(mktemp --suffix .png)
trap 'rm -f "$scene"' EXIT

draw() {  # SCENARIO ARM SIZE [LAYOUT] [SUITE]
  "$lgabench" render "$1" --arm "$2" ${4:+--layout "$4"} ${5:+--suite "$5"} --out "$scene" > /dev/null
  convert "$scene" -sample "$3" -define png:exclude-chunks=date,time "$1-$2.png"
}

draw heart test 25% continuous
for arm in control texture distractor hard; do draw q2_heart $arm 25% continuous; done
for arm in seen unseen seen_varied; do draw q3_utensil $arm 25% continuous; done
for arm in same_place moved crowd; do draw bring_fruit $arm 12.5%; done
for arm in gone control; do draw refusing_heart $arm 25% continuous; done
for arm in few many near; do draw fetch_ripe_fruit $arm 12.5% table fetch; done
draw errands_fruit told 25% continuous errands
draw words_relation_heart_left_of_bowl test 25% continuous
draw drawn_2026_colour_01 test 25% continuous
draw paraphrase_heart original 25% continuous
draw heart control 25% continuous perturbations
for others in 1 2 4 6; do for kind in others near; do draw something_to_drink_water_out_of ${kind}_$others 25% continuous clutter; done; done
for arm in seen new seen_near new_near; do
  draw something_to_drink_water_out_of_members_2 ${arm}_members_2 25% continuous few_members
  mv something_to_drink_water_out_of_members_2-${arm}_members_2.png few_members-$arm.png
done
for arm in new_decisive_near new_other_near seen_matched new_decisive_matched; do
  draw something_to_drink_water_out_of_members_1 ${arm}_members_1 25% continuous few_members
  mv something_to_drink_water_out_of_members_1-${arm}_members_1.png few_members-$arm.png
done
for arm in control clutter new; do
  draw polka_dotted_letter_members ${arm}_members 25% continuous knowledge
  mv polka_dotted_letter_members-${arm}_members.png knowledge-$arm.png
done
for arm in kept moved gone; do
  draw polka_dotted_letter_cue ${arm}_cue 25% continuous knowledge
  mv polka_dotted_letter_cue-${arm}_cue.png knowledge-$arm.png
done
for arm in seen unseen; do
  draw unheard_hearts_commands_4 ${arm}_commands_4 25% continuous many_commands
  mv unheard_hearts_commands_4-${arm}_commands_4.png many_commands-$arm.png
done
