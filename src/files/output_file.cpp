#include "isoweave/output_file.hpp"

#include "files/atomic_file.hpp"

namespace isoweave {

struct OutputFile::File {
  AtomicFile file;
};

OutputFile::OutputFile(const std::string& path) : file_(new File{AtomicFile(path)}) {}
OutputFile::~OutputFile() = default;
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;

void OutputFile::write(std::span<const std::byte> bytes) { file_->file.write(bytes); }

void OutputFile::commit() { file_->file.commit(); }

}  // namespace isoweave
