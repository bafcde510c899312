// schema_check RUN: a line for each way in which a file of the run is not as its schema says; exit 1 if there is one.
#include <cstdio>

#include "../schemas.hpp"

int main(int argc, char** argv) {
  using namespace lgabench;
  if (argc != 2) {
    std::fprintf(stderr, "usage: schema_check RUN\n");
    return 2;
  }
  bool good = true;
  const auto complain = [&good](const std::string& place, const std::string& what) {
    std::printf("%s: %s\n", place.c_str(), what.c_str());
    good = false;
  };
  try {
    for (const fs::path& file : files_with_schema(argv[1])) {
      int count = 0;
      try {
        for (const Json& document : documents(file)) {
          const std::string place = file.string() + ": document " + std::to_string(++count);
          for (const std::string& complaint : complaints(file.stem().string(), document)) complain(place, complaint);
        }
      } catch (const std::exception& e) {  // the other files are still checked
        complain(file.string(), e.what());
      }
    }
  } catch (const std::exception& e) {
    complain(argv[1], e.what());
  }
  return good ? 0 : 1;
}
