# Functions that the scripts share. To be sourced by bash.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s\n' "$*" >&2; }

fail() {
  say "$0: $*"
  exit 1
}

# Runs a command as root: directly, or through sudo.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo > /dev/null; then
    sudo "$@"
  else
    fail "needs root or sudo for: $*"
  fi
}

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2> /dev/null)" = installed ]
}

# Installs the Debian packages that are missing; silent and without root when none is.
install_packages() {
  local missing=() package
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  command -v apt-get > /dev/null || fail "needs a system with apt-get to install: ${missing[*]}"
  say "installing ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { as_root apt-get update && as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"; } > "$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    fail "could not install ${missing[*]}"
  fi
  rm -f "$log"
}

build_packages=(g++ cmake ninja-build libtbb-dev zlib1g-dev libcli11-dev nlohmann-json3-dev libfmt-dev
  libtiff-dev libpng-dev libcharls-dev libopenjp2-7-dev libhdf5-dev libzstd-dev libblosc-dev liblz4-dev liblzma-dev
  libcurl4-openssl-dev libmeshoptimizer-dev libdraco-dev libcpp-httplib-dev pkgconf)
test_packages=(ccache libopenmpi-dev openmpi-bin libmpich-dev mpich libgtest-dev libgdcm-dev clang clang-tidy clang-format libclang-rt-14-dev valgrind
  clang-19 libc++-19-dev libc++abi-19-dev g++-aarch64-linux-gnu qemu-user
  python3-numpy python3-nibabel python3-pydicom python3-tifffile python3-pil python3-vtk9 teem-apps
  python3-h5py python3-numcodecs python3-zarr draco chromium abigail-tools python3-venv
  paraview libvtk9-dev libpython3.11 xvfb lintian man-db mricron-data
  patchelf debootstrap)

# What the page for the browser is built with. Where there is a node that is not Debian's, Debian's npm conflicts with it.
viewer_packages=()
command -v npm > /dev/null || viewer_packages=(nodejs npm)

# Runs a command with its output kept back, and shown only when it fails.
quietly() {
  local log
  log=$(mktemp)
  if ! "$@" > "$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

# Where CUDA's compiler goes: outside any clone, so that the next clone has it.
cuda_folder=${XDG_CACHE_HOME:-$HOME/.cache}/isoweave/cuda-13.0

# The CUDA compiler: the environment's, the system's, NVIDIA's, ours.
find_nvcc() {
  if [ -n "${CUDACXX:-}" ]; then
    echo "$CUDACXX"
  else
    PATH=$PATH:/usr/local/cuda/bin:$cuda_folder/bin command -v nvcc
  fi
}

# Installs CUDA's compiler, without a driver and without root, where none is found; anew when the list of packages changes.
install_nvcc() {
  local list=$root/scripts/cuda-packages.txt unpacked
  if [ -e "$cuda_folder" ] && ! cmp -s "$list" "$cuda_folder/packages.txt"; then rm -rf "$cuda_folder"; fi
  if find_nvcc > /dev/null; then return; fi
  install_packages python3-pip
  say "installing CUDA's compiler into $cuda_folder"
  mkdir -p "$(dirname "$cuda_folder")"
  unpacked=$(mktemp -d -p "$(dirname "$cuda_folder")")
  # Debian's Python, which Debian's pip belongs to.
  quietly /usr/bin/python3 -m pip install --no-deps --require-hashes --only-binary :all: --target "$unpacked" -r "$list" \
    || { rm -rf "$unpacked"; fail "could not install CUDA's compiler"; }
  # The names that a toolkit has beside those of the packages.
  ln -s lib "$unpacked/nvidia/cu13/lib64"
  ln -s libcudart.so.13 "$unpacked/nvidia/cu13/lib/libcudart.so"
  cp "$list" "$unpacked/nvidia/cu13/packages.txt"
  mv -T "$unpacked/nvidia/cu13" "$cuda_folder"
  rm -rf "$unpacked"
}

# Where pvpython is: outside any clone, too, and beside Debian's packages, as python3-paraview conflicts with python3-vtk9,
# which other tests need. What it needs of Debian is among the test_packages.
paraview_folder=${XDG_CACHE_HOME:-$HOME/.cache}/isoweave/paraview

# A Debian of another glibc, with nothing but what every Debian has, for the test of the .tar.gz: outside any clone, too.
other_debian=${XDG_CACHE_HOME:-$HOME/.cache}/isoweave/debian-13

# Installs that Debian where there is none. Needs root.
install_other_debian() {
  if [ -e "$other_debian" ]; then return; fi
  say "installing Debian 13 into $other_debian"
  mkdir -p "$(dirname "$other_debian")"
  local unpacked
  unpacked=$(mktemp -d -p "$(dirname "$other_debian")")
  quietly as_root debootstrap --variant=minbase trixie "$unpacked" \
    || { as_root rm -rf "$unpacked"; fail "could not install Debian 13"; }
  as_root chmod 755 "$unpacked"
  as_root mv -T "$unpacked" "$other_debian"
}

# Unpacks pvpython where there is none.
install_pvpython() {
  if [ -e "$paraview_folder" ]; then return; fi
  say "unpacking pvpython into $paraview_folder"
  mkdir -p "$(dirname "$paraview_folder")"
  local unpacked
  unpacked=$(mktemp -d -p "$(dirname "$paraview_folder")")
  (cd "$unpacked" && quietly apt-get download python3-paraview && dpkg -x python3-paraview_*.deb . && rm ./*.deb) \
    || { rm -rf "$unpacked"; fail "could not unpack pvpython"; }
  mv -T "$unpacked" "$paraview_folder"
}

# Where cloud-volume is, which reads neuroglancer's meshes back. It is not Debian's, so it has an environment of its own,
# outside any clone.
cloud_volume_folder=${XDG_CACHE_HOME:-$HOME/.cache}/isoweave/cloud-volume

# Installs cloud-volume where there is none.
install_cloud_volume() {
  if [ -e "$cloud_volume_folder" ]; then return; fi
  install_packages python3-venv
  say "installing cloud-volume into $cloud_volume_folder"
  mkdir -p "$(dirname "$cloud_volume_folder")"
  local unpacked
  unpacked=$(mktemp -d -p "$(dirname "$cloud_volume_folder")")
  (quietly /usr/bin/python3 -m venv "$unpacked" && quietly "$unpacked/bin/pip" install cloud-volume==12.15.2) \
    || { rm -rf "$unpacked"; fail "could not install cloud-volume"; }
  mv -T "$unpacked" "$cloud_volume_folder"
}
