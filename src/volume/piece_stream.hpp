// Volumes that are kept as several boxes of samples, each with a stream of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "files/byte_stream.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

struct PieceSamples {
  std::unique_ptr<ByteStream> stream;
  bool swap_bytes = false;  // the stored byte order is not the machine's
};

struct VolumePiece {
  Region box;                            // of the volume's samples
  std::function<PieceSamples()> open{};  // called when the first of its slices is reached
};

// The pieces that hold samples which no piece before them holds. Throws BadInput naming `path` when a piece reaches out
// of the volume, or when all pieces together leave samples out.
std::vector<VolumePiece> filling_pieces(std::vector<VolumePiece> pieces, const std::array<std::int64_t, 3>& dims,
                                        const std::string& path);

// A stream of the samples of all pieces in the order of the volume and in the machine's byte order. Holds one slice,
// and the streams of the pieces that are in it.
class PieceStream final : public ByteStream {
 public:
  // `pieces` fill the volume.
  PieceStream(std::vector<VolumePiece> pieces, const std::array<std::int64_t, 3>& dims, std::size_t bytes_each,
              std::string path);

  std::size_t read(std::span<std::byte> out) override;

 private:
  struct OpenPiece {
    VolumePiece piece;
    PieceSamples samples{};
  };

  void fill_slice();
  void add_piece(OpenPiece& open);

  std::vector<OpenPiece> pieces_;
  std::array<std::int64_t, 3> dims_;
  std::size_t bytes_each_;
  std::string path_;
  std::int64_t next_ = 0;  // slice
  std::vector<std::byte> slice_;
  std::size_t used_ = 0;
  std::vector<std::byte> part_;  // of a slice, as a piece has it
};

}  // namespace isoweave
