// Reads the input as the model in a 3MF archive, under a checksum that fits.
#include <vector>

#include "files/zip_archive.hpp"
#include "input_files.hpp"
#include "isoweave/mesh.hpp"

namespace {

using namespace isoweave;

void read_model(const std::string& path) { read_mesh(path); }

std::vector<std::byte> archive_of(std::string_view model) {
  const ZipEntry entry{"3D/3dmodel.model", false, zip_crc(0, model), model.size(), model.size(), 0};
  std::vector<std::byte> archive = zip_header(entry);
  const auto text = std::as_bytes(std::span(model));
  archive.insert(archive.end(), text.begin(), text.end());
  const std::vector<std::byte> directory = zip_directory({&entry, 1}, archive.size());
  archive.insert(archive.end(), directory.begin(), directory.end());
  return archive;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFiles files("a.3mf");
  const std::vector<std::byte> archive = archive_of({reinterpret_cast<const char*>(data), size});
  files.put({reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size()});
  fuzz::expect_bad_input_at_worst(read_model, files.path());
  return 0;
}
