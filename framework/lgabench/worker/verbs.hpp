// The worker's verbs, a file each. Each throws what goes wrong.
#pragma once

namespace lgabench::worker {

void cell();
void check_job();
void ask();
void act();

}  // namespace lgabench::worker
