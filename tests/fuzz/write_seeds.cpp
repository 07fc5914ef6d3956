// Writes the seeds of the fuzzer: write_seeds FOLDER makes FOLDER/TARGET/*.
#include <cstdio>

#include "seeds.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_seeds FOLDER\n", stderr);
    return 2;
  }
  isoweave::fuzz::Seeds seeds(argv[1]);
  isoweave::fuzz::put_files(seeds);
  isoweave::fuzz::put_others(seeds);
  return 0;
}
