#include <lgabench/worker/dispatch.hpp>

int main(int argc, char** argv) { return lgabench::worker::worker_program(argc, argv); }
