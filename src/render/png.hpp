// Pictures as PNG, through libpng.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "isoweave/render.hpp"

namespace isoweave::render {

// Throws CannotWrite, which names `path`, in builds without libpng.
void require_libpng(const std::string& path);

// The bytes of a PNG file. `path` stands for the file in messages.
std::vector<std::byte> png_bytes(const Picture& picture, const std::string& path);

}  // namespace isoweave::render
