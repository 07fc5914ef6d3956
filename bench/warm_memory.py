#!/usr/bin/python3
"""Takes memory and gives it back, so that the next program does not wait for it: the host of a virtual machine has to
find pages that it touches for the first time, or after a while, and that can take longer than what is done with them.

  bench/warm_memory.py MEGABYTES
"""
import mmap
import sys


def warm(size):
    """size: bytes. Huge pages of its own, as isoweave takes: those of memory that could be shared are other ones."""
    with mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS) as memory:
        memory.madvise(mmap.MADV_HUGEPAGE)
        for at in range(0, size, mmap.PAGESIZE):
            memory[at] = 1


if __name__ == "__main__":
    if len(sys.argv) != 2 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    warm(int(sys.argv[1]) << 20)
