// JPEG frames of one component (ITU-T T.81, 1992), as DICOM files hold them: Huffman-coded, sequential DCT (8 or 12
// bits) or lossless (2 to 16 bits). Lossy samples are those of the definition in double precision, rounded; other
// decoders round on the way and differ by 1 here and there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace isoweave {

// The samples of the first frame of a stream. Holds them, and nothing else that a stream can make large. used: bits of
// a lossy sample, where a frame has more; larger ones are cut off. path: for messages. Throws BadInput unless the frame
// has this size and decodes.
std::vector<std::uint16_t> decode_jpeg(const std::string& path, std::span<const std::byte> stream, std::int64_t columns,
                                       std::int64_t rows, int used);

}  // namespace isoweave
