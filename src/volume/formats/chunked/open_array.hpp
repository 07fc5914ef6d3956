// Volumes that are kept as chunks in a store: Zarr, OME-Zarr, N5.
#pragma once

#include <string>

#include "files/object_store.hpp"
#include "isoweave/volume.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// folder: as the store's paths show it. Throws BadInput.
OpenedVolume open_array(const StorePtr& store, const std::string& folder, const OpenOptions& options);

}  // namespace isoweave
