// Runs whose memory ends: at the first, second, third ... request an exception comes out, never a crash and never a
// wait without end.
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <functional>
#include <new>
#include <string>

#include "isoweave/generate.hpp"
#include "isoweave/pipeline.hpp"

namespace {

std::atomic<long> requests_left{-1};  // that are granted; below 0: all

bool is_refused() { return requests_left.load(std::memory_order_relaxed) >= 0 && requests_left.fetch_sub(1) == 0; }

void* taken(std::size_t bytes, std::size_t alignment) {
  void* const memory = is_refused() ? nullptr : memalign(alignment, bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Of the program and all its libraries. What the library takes without `new` comes by the two below.
void* operator new(std::size_t bytes) { return taken(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return taken(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  if (!is_refused()) return memalign(alignment, bytes);
  errno = ENOMEM;
  return nullptr;
}

extern "C" void* mmap(void* address, std::size_t bytes, int protection, int flags, int fd, off_t offset) noexcept {
  if (is_refused()) {
    errno = ENOMEM;
    return MAP_FAILED;
  }
  return reinterpret_cast<void*>(::syscall(SYS_mmap, address, bytes, protection, flags, fd, offset));
}

namespace isoweave {
namespace {

GenerateOptions noise() {
  GenerateOptions volume;
  volume.kind = "noise";
  volume.dims = {14, 14, 24};
  volume.type = SampleType::kUint8;
  return volume;
}

MeshOptions options_of() {
  MeshOptions options;
  options.iso = 127.5;
  options.error = Length::voxels(0.3);
  return options;
}

// How many requests the function makes at most; at each of them, or at every `step`th, it must throw std::bad_alloc.
void expect_exceptions(long step, const std::function<void()>& run) {
  run();  // what is made once is there
  long failed = 0;
  for (long granted = 0;; granted += step) {
    requests_left = granted;
    bool threw = false;
    try {
      run();
    } catch (const std::bad_alloc&) {
      threw = true;
    }
    const bool refused = requests_left.exchange(-1) < 0;
    if (!refused) break;
    EXPECT_TRUE(threw) << "request " << granted;
    failed += 1;
  }
  EXPECT_GT(failed, 20);
}

class FailingMemory : public ::testing::TestWithParam<int> {};

TEST_P(FailingMemory, MeshingAVolumeThrows) {
  RunControl control;
  control.slab = 4;
  control.threads = GetParam();
  expect_exceptions(GetParam() == 1 ? 1 : 3, [&] {
    MeshInMemory mesh;
    mesh_volume(*generate_volume(noise()), mesh, options_of(), control);
  });
}

TEST_P(FailingMemory, SimplifyingAMeshThrows) {
  TriangleMesh mesh;
  {
    MeshInMemory full;
    MeshOptions options = options_of();
    options.error = Length::voxels(0);
    mesh_volume(*generate_volume(noise()), full, options);
    mesh.vertices.assign(full.vertices().begin(), full.vertices().end());
    mesh.triangles.assign(full.triangles().begin(), full.triangles().end());
  }
  RunControl control;
  control.threads = GetParam();
  SimplifyOptions options;
  options.error = Length::units(0.3);
  expect_exceptions(GetParam() == 1 ? 1 : 3, [&] {
    MeshInMemory simplified;
    simplify_mesh(mesh, simplified, options, control);
  });
}

INSTANTIATE_TEST_SUITE_P(Threads, FailingMemory, ::testing::Values(1, 2, 4));

}  // namespace
}  // namespace isoweave
