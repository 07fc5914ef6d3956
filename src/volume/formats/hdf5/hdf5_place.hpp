// Formats that stand on HDF5 and say where samples lie: Imaris, ITK's images, MINC 2, DREAM.3D, VTKHDF. To be used
// inside a session.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "volume/axes.hpp"
#include "volume/formats/hdf5/hdf5_dataset.hpp"
#include "volume/formats/hdf5/hdf5_library.hpp"

namespace isoweave {

struct Hdf5File {
  const Hdf5Session& session;
  hid_t id;
  std::string path;  // for messages
};

// The description that a format gives of one dataset.
struct Hdf5Place {
  std::string format;                   // for notes
  std::string dataset;                  // its path in the file
  std::string part;                     // what was chosen, where the format keeps it in datasets of their own
  bool chosen = false;                  // level, channel and time have been used up by the choice of the dataset
  std::vector<std::string> axis_names;  // of the dataset, from the slowest to the fastest
  std::vector<std::int64_t> shape;      // samples that count, where a dataset is padded; else empty
  Axes axes;                            // of x, y and z
  std::array<std::string, 3> units;
  Space space = Space::kUnknown;
  // Scaling of the samples, where there is one: a single one, or one for each index along the first axes.
  std::vector<double> slope;
  std::vector<double> intercept;
  std::size_t scaled_axes = 0;
  bool has_values = false;  // the format itself says which values samples stand for
  std::vector<std::string> notes;
};

// The places of datasets in files of each format; nothing where the file is not of that format. `named`: the dataset
// that the caller names, with a slash in front. Where it is empty, the dataset is the one that the format has for
// volumes and that `options` choose. Throw BadInput where such a file contradicts its format, and for choices outside
// it.
std::optional<Hdf5Place> imaris_place(const Hdf5File& file, const std::string& named, const OpenOptions& options);
std::optional<Hdf5Place> itk_place(const Hdf5File& file, const std::string& named);
std::optional<Hdf5Place> minc_place(const Hdf5File& file, const std::string& named);
// DREAM.3D and VTKHDF have no one dataset for volumes: it must be named, or be the only one.
std::optional<Hdf5Place> dream3d_place(const Hdf5File& file, const std::string& named);
std::optional<Hdf5Place> vtkhdf_place(const Hdf5File& file, const std::string& named);

// The first of the above that knows the dataset.
std::optional<Hdf5Place> find_hdf5_place(const Hdf5File& file, const std::string& named, const OpenOptions& options);

// An object of the file; none where there is no such path. Throws BadInput where it lies in another file.
Hdf5Handle open_object(const Hdf5File& file, const std::string& name);

// The numbers of a dataset, of a bounded number of them; nothing where there is none, or it holds something else.
std::optional<std::vector<double>> numbers_in(const Hdf5File& file, const std::string& name);

// An attribute as text, also where it is kept as one character each or as a number; empty where there is none.
std::string text_in(const ArrayAttributes& attributes, const std::string& name);

// "b" of "/a/b/c" for 1, "c" for 0, counted from the end; empty where there are fewer.
std::string step_of_path(const std::string& name, std::size_t from_end);
// "/a/b" of "/a/b/c".
std::string folder_of_path(const std::string& name);

}  // namespace isoweave
