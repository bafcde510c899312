#include <lgabench/cli/programs.hpp>
#include <lgabench/core/version.hpp>

#include "lgabench_commit.hpp"  // written by cmake/commit.cmake

int main(int argc, char** argv) {
  return lgabench::cli::lgabench_program(
      argc, argv, "lgabench " LGABENCH_VERSION " (commit " LGABENCH_COMMIT ", " LGABENCH_BUILD ")");
}
