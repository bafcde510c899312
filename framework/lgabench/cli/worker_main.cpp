#include <lgabench/cli/programs.hpp>

int main(int argc, char** argv) { return lgabench::cli::worker_program(argc, argv); }
