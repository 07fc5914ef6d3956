# Shared by the benchmarks. To be sourced by bash; needs $isoweave.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

brain=/usr/share/mricron/templates/ch2better.nii.gz
skull_tar=/usr/share/doc/invesalius-examples/examples/Cranium.inv3

# Options that open the CT skull; makes its raw file first.
skull_options() {
  [ -e "$work/skull.raw" ] || tar xf "$skull_tar" -O --wildcards 'tmp*/matrix.dat' > "$work/skull.raw"
  printf '%s\n' "$work/skull.raw" --raw 256x256x108:int16 --spacing 0.957031,0.957031,1.5
}

# A number out of a report: value FILE KEY
value() { grep -m1 "\"$2\":" "$1" | tr -dc '0-9.'; }

digest_of() { grep -m1 '"digest"' "$1" | cut -d'"' -f4; }
