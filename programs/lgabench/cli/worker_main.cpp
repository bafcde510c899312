#include <lgabench/cli/programs.hpp>

int main(int argc, char** argv) { return lgabench::cli::worker_with_programs(argc, argv); }
