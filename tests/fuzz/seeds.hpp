// Folders of seeds, and what fills those that are many.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "input_files.hpp"

namespace isoweave::fuzz {

inline const std::string kNext(kNextFile);

class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void put(const std::string& target, const std::string& content) {
    const std::filesystem::path folder = folder_ / target;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / std::to_string(count_[target]++), std::ios::binary) << content;
  }

 private:
  std::filesystem::path folder_;
  std::map<std::string, int> count_;
};

// Volumes and meshes of all formats.
void put_files(Seeds& seeds);

// Options, calls of the C interface, names of labels, states, files of tasks, indices.
void put_others(Seeds& seeds);

// Zarr 2 and 3, OME-Zarr, N5, precomputed volumes.
void put_arrays(Seeds& seeds);

// Calls of the C interface.
void put_c_interface(Seeds& seeds);

// States of runs, and the files of tasks, behind their beginnings.
void put_state_bodies(Seeds& seeds);
void put_task_bodies(Seeds& seeds);

// Meshes of other programs in VTP, legacy VTK, 3MF and GLB; volumes in VTR and NPZ.
void put_packages(Seeds& seeds);

}  // namespace isoweave::fuzz
